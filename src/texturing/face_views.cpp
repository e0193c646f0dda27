#include "texturing/face_views.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "surface_mesh/triangle_pixels.h"
#include "texturing/mesh_in_view.h"
#include "texturing/surface_points.h"

namespace depth_fusion {
namespace {

constexpr float kMargin_px = 3.0f;
constexpr int kBlur_px = 9;
constexpr float kLeastSlope = 1.0f;      // brightness a pixel: where all is plain, size alone counts
constexpr float kOutlineQuality = 0.1f;  // the background may show where depth and colour differ a little

// A picture, and what it is like about each pixel.
struct BlurredImage {
  cv::Mat color;  // CV_8UC3
  cv::Mat slope;  // CV_32FC1

  explicit BlurredImage(const cv::Mat& image) {
    cv::Mat brightness, slope_u, slope_v;
    cv::blur(image, color, {kBlur_px / 2 + 1, kBlur_px / 2 + 1});
    cv::cvtColor(image, brightness, cv::COLOR_BGR2GRAY);
    cv::Sobel(brightness, slope_u, CV_32F, 1, 0, 3, 1.0 / 8.0);
    cv::Sobel(brightness, slope_v, CV_32F, 0, 1, 3, 1.0 / 8.0);
    cv::magnitude(slope_u, slope_v, slope);
    cv::blur(slope, slope, {kBlur_px, kBlur_px});
  }
};

class FaceInView {
 public:
  FaceInView(const TriangleMesh& mesh, const ChosenView& chosen, uint16_t number,
             const TexturingParameters& parameters)
      : mesh_(mesh),
        chosen_(chosen),
        number_(number),
        least_cosine_(std::cos(parameters.max_incidence_rad)),
        eye_W_(chosen.view.T_W_C.translation().cast<float>()),
        in_view_(mesh, chosen.view, parameters.hidden_ratio),
        image_(imageOf(chosen.view)) {}

  // Returns kNoView if it does not show all of the face.
  FaceView of(const MeshTriangle& t) const {
    const Eigen::Vector3f ray_W = eye_W_ - mesh_.vertices[t[0]].position_W;
    if (areaNormal(mesh_, t).normalized().dot(ray_W.normalized()) < least_cosine_) return {};
    std::array<cv::Point2f, 3> corners;
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();
    bool at_outline = false;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3f& uvz = in_view_.pixels()[t[i]];
      if (!isInside(uvz, chosen_.view.camera, kMargin_px) || !in_view_.sees(uvz)) return {};
      at_outline = at_outline || in_view_.isAtOutline(uvz);
      corners[i] = {uvz.x(), uvz.y()};
      middle += uvz / 3.0f;
    }
    if (!in_view_.sees(middle)) return {};
    const float pixels = 0.5f * std::abs(twiceTheArea(corners[0], corners[1], corners[2]));
    const cv::Point pixel(cvRound(middle.x()), cvRound(middle.y()));
    FaceView view{number_, {}, pixels * (kLeastSlope + image_.slope.at<float>(pixel))};
    if (at_outline) view.quality *= kOutlineQuality;
    const cv::Vec3b& color = image_.color.at<cv::Vec3b>(pixel);
    for (int i = 0; i < 3; ++i)
      view.color[i] = cv::saturate_cast<uint8_t>(chosen_.gain[i] * static_cast<double>(color[i]));
    return view;
  }

 private:
  const TriangleMesh& mesh_;
  const ChosenView& chosen_;
  const uint16_t number_;
  const float least_cosine_;
  const Eigen::Vector3f eye_W_;
  const MeshInView in_view_;
  const BlurredImage image_;
};

// Keeps the best, in order.
void insert(FaceViews& views, const FaceView& added) {
  if (added.quality <= views.back().quality) return;
  size_t place = views.size() - 1;
  for (; place > 0 && views[place - 1].quality < added.quality; --place) views[place] = views[place - 1];
  views[place] = added;
}

int medianOf(std::array<int, kMostViewsOfFace>& values, int count) {
  std::nth_element(values.begin(), values.begin() + count / 2, values.begin() + count);
  return values[static_cast<size_t>(count) / 2];
}

size_t removeOutliersOf(FaceViews& views, double outlier_levels) {
  constexpr int kFewest = 3;
  constexpr double kSigmaOfMedian = 1.4826, kSigmas = 3.0;
  const int count = countOf(views);
  if (count < kFewest) return 0;
  FaceViews kept;
  std::array<bool, kMostViewsOfFace> is_good;
  is_good.fill(true);
  for (int channel = 0; channel < 3; ++channel) {
    std::array<int, kMostViewsOfFace> values{}, apart{};
    for (int i = 0; i < count; ++i) values[i] = views[i].color[channel];
    const int middle = medianOf(values, count);
    for (int i = 0; i < count; ++i) apart[i] = std::abs(views[i].color[channel] - middle);
    const double limit =
        std::max(outlier_levels, kSigmas * kSigmaOfMedian * static_cast<double>(medianOf(apart, count)));
    for (int i = 0; i < count; ++i)
      is_good[i] = is_good[i] && std::abs(views[i].color[channel] - middle) <= limit;
  }
  size_t left = 0;
  for (int i = 0; i < count; ++i) {
    if (is_good[i]) kept[left++] = views[i];
  }
  if (left == 0) return 0;
  views = kept;
  return static_cast<size_t>(count) - left;
}

}  // namespace

int countOf(const FaceViews& views) {
  int count = 0;
  while (count < kMostViewsOfFace && views[count].view != kNoView) ++count;
  return count;
}

int placeOf(const FaceViews& views, uint16_t view) {
  for (int i = 0; i < kMostViewsOfFace && views[i].view != kNoView; ++i) {
    if (views[i].view == view) return i;
  }
  return -1;
}

std::vector<FaceViews> viewsOfFaces(const TriangleMesh& mesh, const std::vector<ChosenView>& views,
                                    const TexturingParameters& parameters,
                                    const std::function<void(double)>& progress) {
  std::vector<FaceViews> faces(mesh.triangles.size());
  for (size_t number = 0; number < views.size(); ++number) {
    progress(static_cast<double>(number) / static_cast<double>(views.size()));
    const FaceInView view(mesh, views[number], static_cast<uint16_t>(number), parameters);
    cv::parallel_for_({0, static_cast<int>(faces.size())}, [&](const cv::Range& range) {
      for (int i = range.start; i < range.end; ++i) insert(faces[i], view.of(mesh.triangles[i]));
    });
  }
  return faces;
}

size_t removeOutliers(std::vector<FaceViews>& faces, double outlier_levels) {
  size_t removed = 0;
  for (FaceViews& views : faces) removed += removeOutliersOf(views, outlier_levels);
  return removed;
}

}  // namespace depth_fusion
