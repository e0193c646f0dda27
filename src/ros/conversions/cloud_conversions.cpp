#include "ros/conversions/cloud_conversions.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

using sensor_msgs::PointCloud2;
using sensor_msgs::PointField;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr size_t kFewestPoints = 100;
constexpr double kMaxResidual_px = 0.5;
constexpr uint32_t kCheckedStep = 7;  // rows and columns from one checked point to the next

const PointField* findField(const PointCloud2& cloud, const std::string& name, uint8_t type) {
  for (const PointField& field : cloud.fields) {
    if (field.name == name && field.datatype == type && field.offset + 4 <= cloud.point_step) return &field;
  }
  return nullptr;
}

// A field of four bytes, wherever rows begin.
template <class Value>
class Field {
 public:
  Field(const PointCloud2& cloud, const PointField& field)
      : bytes_(cloud.data.data() + field.offset), row_step_(cloud.row_step), point_step_(cloud.point_step) {}

  Value at(uint32_t row, uint32_t column) const {
    Value value;
    std::memcpy(&value,
                bytes_ + static_cast<size_t>(row) * row_step_ + static_cast<size_t>(column) * point_step_,
                sizeof(value));
    return value;
  }

 private:
  const uint8_t* bytes_;
  size_t row_step_, point_step_;
};

void checkCloud(const PointCloud2& cloud, const std::string& topic) {
  const size_t row_bytes = static_cast<size_t>(cloud.width) * cloud.point_step;
  check(!cloud.is_bigendian, topic + ": a cloud is big-endian, which is not taken");
  check(
      cloud.row_step >= row_bytes &&
          (cloud.height == 0 || cloud.data.size() >= cloud.row_step * (cloud.height - size_t{1}) + row_bytes),
      topic + ": a cloud has less data than its width and height say; it is truncated");
}

class Points {
 public:
  Points(const PointCloud2& cloud, const std::string& topic)
      : x_(fieldOf(cloud, "x", topic)), y_(fieldOf(cloud, "y", topic)), z_(fieldOf(cloud, "z", topic)) {}

  Eigen::Vector3f at(uint32_t row, uint32_t column) const {
    return {x_.at(row, column), y_.at(row, column), z_.at(row, column)};
  }
  float depthAt(uint32_t row, uint32_t column) const { return z_.at(row, column); }

 private:
  static Field<float> fieldOf(const PointCloud2& cloud, const std::string& name, const std::string& topic) {
    checkCloud(cloud, topic);
    const PointField* field = findField(cloud, name, PointField::FLOAT32);
    check(field != nullptr, topic + ": a cloud has no field " + name + " of 32-bit floats");
    return {cloud, *field};
  }

  Field<float> x_, y_, z_;
};

// The line place = focal * slope + principal through points of an image, along one axis.
struct Line {
  double focal = 0.0, principal = 0.0, worst_px = 0.0;
};

Line fitLine(const std::vector<Eigen::Vector2d>& slope_and_place) {
  const auto count = static_cast<double>(slope_and_place.size());
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : slope_and_place) mean += point / count;
  double variance = 0.0, covariance = 0.0;
  for (const Eigen::Vector2d& point : slope_and_place) {
    variance += (point.x() - mean.x()) * (point.x() - mean.x());
    covariance += (point.x() - mean.x()) * (point.y() - mean.y());
  }
  Line line;
  line.focal = variance > 0.0 ? covariance / variance : 0.0;
  line.principal = mean.y() - line.focal * mean.x();
  for (const Eigen::Vector2d& point : slope_and_place)
    line.worst_px = std::max(line.worst_px, std::abs(line.focal * point.x() + line.principal - point.y()));
  return line;
}

uint8_t grey(float intensity) { return static_cast<uint8_t>(std::clamp(intensity, 0.0f, 255.0f)); }

}  // namespace

bool isOrganised(const PointCloud2& cloud) { return cloud.height > 1; }

CameraIntrinsics cameraOfCloud(const PointCloud2& cloud, const std::string& topic) {
  const Points points(cloud, topic);
  std::vector<Eigen::Vector2d> columns, rows;
  for (uint32_t row = 0; row < cloud.height; ++row) {
    for (uint32_t column = 0; column < cloud.width; ++column) {
      const Eigen::Vector3d p = points.at(row, column).cast<double>();
      if (!p.allFinite() || p.z() <= 0.0) continue;
      columns.emplace_back(p.x() / p.z(), column);
      rows.emplace_back(p.y() / p.z(), row);
    }
  }
  check(columns.size() >= kFewestPoints,
        topic + ": a cloud has " + std::to_string(columns.size()) + " points, too few to tell its camera");
  const Line x = fitLine(columns), y = fitLine(rows);
  CameraIntrinsics camera{static_cast<int>(cloud.width),
                          static_cast<int>(cloud.height),
                          x.focal,
                          y.focal,
                          x.principal,
                          y.principal};
  check(camera.valid() && std::max(x.worst_px, y.worst_px) <= kMaxResidual_px,
        topic +
            ": the points of a cloud do not lie where the pixels of a pinhole camera see them; it must be in "
            "the camera's optical frame, as the driver publishes it");
  return camera;
}

bool isCameraOf(const CameraIntrinsics& camera, const PointCloud2& cloud, const std::string& topic) {
  const cv::Size size(static_cast<int>(cloud.width), static_cast<int>(cloud.height));
  if (cv::Size(camera.width, camera.height) != size) return false;
  const Points points(cloud, topic);
  for (uint32_t row = 0; row < cloud.height; row += kCheckedStep) {
    for (uint32_t column = 0; column < cloud.width; column += kCheckedStep) {
      const Eigen::Vector3d p = points.at(row, column).cast<double>();
      if (!p.allFinite() || p.z() <= 0.0) continue;
      const double u = camera.fx * p.x() / p.z() + camera.cx, v = camera.fy * p.y() / p.z() + camera.cy;
      if (std::max(std::abs(u - column), std::abs(v - row)) > kMaxResidual_px) return false;
    }
  }
  return true;
}

cv::Mat depthOfCloud(const PointCloud2& cloud, const std::string& topic) {
  const Points points(cloud, topic);
  cv::Mat depth(static_cast<int>(cloud.height), static_cast<int>(cloud.width), CV_32FC1);
  for (uint32_t row = 0; row < cloud.height; ++row) {
    float* out = depth.ptr<float>(static_cast<int>(row));
    for (uint32_t column = 0; column < cloud.width; ++column) out[column] = points.depthAt(row, column);
  }
  return depth;
}

cv::Mat colorOfCloud(const PointCloud2& cloud) {
  const cv::Size size(static_cast<int>(cloud.width), static_cast<int>(cloud.height));
  const PointField* rgb = findField(cloud, "rgb", PointField::FLOAT32);
  if (rgb == nullptr) rgb = findField(cloud, "rgb", PointField::UINT32);
  if (rgb == nullptr) rgb = findField(cloud, "rgba", PointField::UINT32);
  const PointField* intensity = findField(cloud, "intensity", PointField::FLOAT32);
  if (rgb != nullptr) {
    const Field<uint32_t> values(cloud, *rgb);
    cv::Mat color(size, CV_8UC3);
    color.forEach<cv::Vec3b>([&](cv::Vec3b& pixel, const int* place) {
      const uint32_t value = values.at(static_cast<uint32_t>(place[0]), static_cast<uint32_t>(place[1]));
      for (int channel = 0; channel < 3; ++channel)
        pixel[channel] = static_cast<uint8_t>(value >> (8 * channel) & 0xff);
    });
    return color;
  }
  if (intensity == nullptr) return {};
  const Field<float> values(cloud, *intensity);
  cv::Mat color(size, CV_8UC1);
  color.forEach<uint8_t>([&](uint8_t& pixel, const int* place) {
    pixel = grey(values.at(static_cast<uint32_t>(place[0]), static_cast<uint32_t>(place[1])));
  });
  return color;
}

cv::Mat depthOfPoints(const PointCloud2& cloud, const CameraIntrinsics& camera, const std::string& topic) {
  const Points points(cloud, topic);
  cv::Mat depth(camera.height, camera.width, CV_32FC1, cv::Scalar(kNone));
  for (uint32_t row = 0; row < cloud.height; ++row) {
    for (uint32_t column = 0; column < cloud.width; ++column) {
      const Eigen::Vector3f p = points.at(row, column);
      if (!p.allFinite() || p.z() <= 0.0f) continue;
      const double u = camera.fx * p.x() / p.z() + camera.cx + 0.5;
      const double v = camera.fy * p.y() / p.z() + camera.cy + 0.5;
      if (!(u >= 0.0 && v >= 0.0 && u < camera.width && v < camera.height)) continue;
      float& nearest = depth.at<float>(static_cast<int>(v), static_cast<int>(u));
      if (!(nearest <= p.z())) nearest = p.z();
    }
  }
  return depth;
}

}  // namespace depth_fusion
