// A wall with letters of 3 cm, and pictures of it.
#pragma once

#include <Eigen/Geometry>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "depth_fusion/surface_mesh/triangle_mesh.h"
#include "depth_fusion/texturing/texturing.h"

namespace depth_fusion {

// The wall is z = 0, seen from z < 0; x goes right and y down, as in its painting.
class PaintedWall {
 public:
  static constexpr double kWidth_m = 1.2, kHeight_m = 0.8;
  static constexpr double kPixel_m = 0.0005;
  static constexpr double kLetter_m = 0.03;

  PaintedWall() {
    painting_ = cv::Mat(cvRound(kHeight_m / kPixel_m), cvRound(kWidth_m / kPixel_m), CV_8UC3);
    for (int y = 0; y < painting_.rows; ++y) {
      for (int x = 0; x < painting_.cols; ++x) {
        const double u = x * kPixel_m, v = y * kPixel_m;
        painting_.at<cv::Vec3b>(y, x) =
            cv::Vec3b(cv::saturate_cast<uchar>(150 + 40 * std::sin(7 * u + 2 * v)),
                      cv::saturate_cast<uchar>(160 + 40 * std::sin(5 * v)),
                      cv::saturate_cast<uchar>(170 + 30 * std::cos(9 * u)));
      }
    }
    for (size_t i = 0; i < text().size(); ++i) {
      const cv::Mat letter = template_(text()[i]);
      cv::Mat place = painting_(cellOf(i));
      place.setTo(cv::Scalar(30, 25, 40), letter);
    }
  }

  static std::string text() { return "DEPTHFUSIONREADSLABELSWELL"; }
  // The letter's place in the painting, pixels.
  static cv::Rect cellOf(size_t i) {
    const int cell = cvRound(1.5 * kLetter_m / kPixel_m);
    return {cell * (3 + static_cast<int>(i % 13) * 3 / 2), cell * (4 + 4 * static_cast<int>(i / 13)), cell,
            cell};
  }
  // A letter of 3 cm in a cell, 255 on 0.
  static cv::Mat template_(char letter) {
    const int cell = cvRound(1.5 * kLetter_m / kPixel_m);
    cv::Mat picture(cell, cell, CV_8UC1, cv::Scalar(0));
    const double scale = kLetter_m / kPixel_m / 21.0;  // capitals of this font are 21 pixels high
    cv::putText(picture, std::string(1, letter), {cell / 6, cell * 5 / 6}, cv::FONT_HERSHEY_SIMPLEX, scale,
                255, cvRound(4.0e-3 / kPixel_m), cv::LINE_AA);
    return picture;
  }

  const cv::Mat& painting() const { return painting_; }

  static CameraIntrinsics camera() { return {640, 480, 525.0, 525.0, 319.5, 239.5}; }

  // The camera at (x, y), so far before the wall, turned about its y axis.
  static Pose poseAt(double x_m, double y_m, double distance_m, double yaw_rad) {
    Pose T_W_C = Pose::Identity();
    T_W_C.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
    T_W_C.translation() = Eigen::Vector3d(x_m, y_m, -distance_m);
    return T_W_C;
  }

  // What the camera sees; each pixel is the mean of 4x4, and black beside the wall.
  cv::Mat picture(const Pose& T_W_C) const {
    const Pose T_C_W = T_W_C.inverse();
    const CameraIntrinsics c = camera();
    const Eigen::Matrix3d K = (Eigen::Matrix3d() << c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1).finished();
    Eigen::Matrix3d plane;  // from painting pixels to the camera
    plane << T_C_W.linear().col(0) * kPixel_m, T_C_W.linear().col(1) * kPixel_m,
        T_C_W.translation() -
            0.5 * T_C_W.linear() * Eigen::Vector3d(kWidth_m - kPixel_m, kHeight_m - kPixel_m, 0);
    constexpr int kFine = 4;
    Eigen::Matrix3d finer;
    finer << kFine, 0, (kFine - 1) / 2.0, 0, kFine, (kFine - 1) / 2.0, 0, 0, 1;
    const Eigen::Matrix3d H = finer * K * plane;
    cv::Mat homography(3, 3, CV_64F);
    for (int i = 0; i < 9; ++i) homography.at<double>(i / 3, i % 3) = H(i / 3, i % 3);
    cv::Mat fine, picture;
    cv::warpPerspective(painting_, fine, homography, {kFine * c.width, kFine * c.height}, cv::INTER_LINEAR);
    cv::resize(fine, picture, {c.width, c.height}, 0, 0, cv::INTER_AREA);
    return picture;
  }

  static TexturingView viewOf(const cv::Mat& picture, const Pose& T_W_C) {
    std::vector<uchar> bytes;
    cv::imencode(".png", picture, bytes);
    return {{bytes.begin(), bytes.end()}, camera(), T_W_C};
  }

  // The wall in squares of that edge; its vertices have the painting's colours.
  TriangleMesh mesh(double edge_m) const {
    TriangleMesh mesh;
    const int columns = cvRound(kWidth_m / edge_m), rows = cvRound(kHeight_m / edge_m);
    for (int y = 0; y <= rows; ++y) {
      for (int x = 0; x <= columns; ++x) {
        mesh.vertices.push_back(
            {Eigen::Vector3d(x * edge_m - kWidth_m / 2, y * edge_m - kHeight_m / 2, 0).cast<float>(),
             -Eigen::Vector3f::UnitZ()});
        const cv::Vec3b& bgr =
            painting_.at<cv::Vec3b>(std::min(cvRound(y * edge_m / kPixel_m), painting_.rows - 1),
                                    std::min(cvRound(x * edge_m / kPixel_m), painting_.cols - 1));
        mesh.colors.push_back({bgr[2], bgr[1], bgr[0]});
        if (x == columns || y == rows) continue;
        const auto a = static_cast<uint32_t>(y * (columns + 1) + x), b = a + 1, c = a + columns + 1,
                   d = c + 1;
        mesh.triangles.push_back({a, c, b});
        mesh.triangles.push_back({b, c, d});
      }
    }
    return mesh;
  }

  // Reads the letter in a cell of a picture that was taken like the painting: the one whose template fits
  // best.
  static char read(const cv::Mat& picture_of_painting, size_t i) {
    cv::Mat grey;
    cv::cvtColor(picture_of_painting(cellOf(i)), grey, cv::COLOR_BGR2GRAY);
    grey = 255 - grey;
    char best = '?';
    double best_fit = 0.0;
    for (char letter = 'A'; letter <= 'Z'; ++letter) {
      cv::Mat blurred, fit;
      cv::GaussianBlur(template_(letter), blurred, {}, 2.0);
      const int shift = 6;
      cv::matchTemplate(grey,
                        blurred(cv::Rect(shift, shift, blurred.cols - 2 * shift, blurred.rows - 2 * shift)),
                        fit, cv::TM_CCOEFF_NORMED);
      double most = 0.0;
      cv::minMaxLoc(fit, nullptr, &most);
      if (most <= best_fit) continue;
      best_fit = most;
      best = letter;
    }
    return best;
  }

 private:
  cv::Mat painting_;
};

}  // namespace depth_fusion
