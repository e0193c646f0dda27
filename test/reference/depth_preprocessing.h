// The kernels of kernels/preprocessing/preprocessing.cl, plainly: pixel by pixel, in double.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "depth_fusion/geometry/camera_intrinsics.h"
#include "shared/types.h"

namespace depth_fusion::reference {

// Returns the axial sigma of the default sensor.
inline double sensorSigma(double depth_m) { return 0.0012 + 0.0019 * (depth_m - 0.4) * (depth_m - 0.4); }

// Calls visit(x, y, pixel) for every pixel of the image.
template <class Pixel, class Visit>
void forEachPixel(cv::Mat& image, const Visit& visit) {
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) visit(x, y, image.at<Pixel>(y, x));
  }
}

inline float depthOr0(const cv::Mat& depth, int x, int y) {
  const bool inside = x >= 0 && y >= 0 && x < depth.cols && y < depth.rows;
  return inside ? depth.at<float>(y, x) : 0.0f;
}

inline cv::Mat depthToMetres(const cv::Mat& input, const RangeArgs& range) {
  cv::Mat depth(input.size(), CV_32FC1);
  forEachPixel<float>(depth, [&](int x, int y, float& pixel) {
    const float units = input.type() == CV_16UC1 ? input.at<uint16_t>(y, x) : input.at<float>(y, x);
    const float metres = units * range.unit_m;
    pixel = metres >= range.min_range_m && metres <= range.max_range_m ? metres : 0.0f;
  });
  return depth;
}

inline cv::Mat filterBilateral(const cv::Mat& depth, double sigma_px, double cutoff_sigmas) {
  cv::Mat filtered = cv::Mat::zeros(depth.size(), CV_32FC1);
  forEachPixel<float>(filtered, [&](int x, int y, float& pixel) {
    const double centre = depth.at<float>(y, x);
    if (centre == 0.0) return;
    double sum = 0.0;
    double weights = 0.0;
    for (int dy = -2; dy <= 2; ++dy) {
      for (int dx = -2; dx <= 2; ++dx) {
        const double neighbour = depthOr0(depth, x + dx, y + dy);
        const double relative = (neighbour - centre) / (cutoff_sigmas * sensorSigma(centre));
        if (neighbour == 0.0 || std::abs(relative) >= 1.0) continue;
        const double biweight = (1.0 - relative * relative) * (1.0 - relative * relative);
        const double weight = std::exp(-(dx * dx + dy * dy) / (2.0 * sigma_px * sigma_px)) * biweight;
        sum += weight * neighbour;
        weights += weight;
      }
    }
    pixel = static_cast<float>(sum / weights);
  });
  return filtered;
}

inline cv::Mat halveDepth(const cv::Mat& depth, double cutoff_sigmas) {
  cv::Mat half = cv::Mat::zeros(depth.rows / 2, depth.cols / 2, CV_32FC1);
  forEachPixel<float>(half, [&](int x, int y, float& pixel) {
    std::vector<double> known;
    for (int i = 0; i < 4; ++i) {
      const float z = depth.at<float>(2 * y + i / 2, 2 * x + i % 2);
      if (z > 0.0f) known.push_back(z);
    }
    if (known.empty()) return;
    const double closest = *std::min_element(known.begin(), known.end());
    double sum = 0.0;
    int count = 0;
    for (const double z : known) {
      if (z > closest + cutoff_sigmas * sensorSigma(closest)) continue;
      sum += z;
      ++count;
    }
    pixel = static_cast<float>(sum / count);
  });
  return half;
}

// The plane z = a + b du + c dv is fitted to the 3x3 pixels two apart. As a surface, it has the normal
// (fx b, fy c, -(z + u b + v c)), with (u, v) from the principal point.
inline cv::Mat computeNormals(const cv::Mat& depth, const CameraIntrinsics& camera,
                              double max_relative_step) {
  cv::Mat normals = cv::Mat::zeros(depth.size(), CV_32FC3);
  forEachPixel<cv::Vec3f>(normals, [&](int x, int y, cv::Vec3f& pixel) {
    const double z = depth.at<float>(y, x);
    double b = 0.0;
    double c = 0.0;
    for (int dv = -1; dv <= 1; ++dv) {
      for (int du = -1; du <= 1; ++du) {
        const double neighbour = depthOr0(depth, x + 2 * du, y + 2 * dv);
        if (neighbour == 0.0 || std::abs(neighbour - z) >= max_relative_step * z) return;
        b += du * neighbour / 12.0;
        c += dv * neighbour / 12.0;
      }
    }
    const cv::Vec3d normal(camera.fx * b, camera.fy * c, -(z + (x - camera.cx) * b + (y - camera.cy) * c));
    pixel = cv::Vec3f(normal / cv::norm(normal));
  });
  return normals;
}

// Returns depth, cosine of the incidence and accuracy of each pixel, by the default sensor; 0 = no
// measurement.
inline cv::Mat measurements(const cv::Mat& depth, const cv::Mat& normals, const cv::Mat& weights,
                            const CameraIntrinsics& camera) {
  const double lateral_px = 0.8;
  const double edge_sigmas = 2.0;
  cv::Mat result = cv::Mat::zeros(depth.size(), CV_32FC3);
  forEachPixel<cv::Vec3f>(result, [&](int x, int y, cv::Vec3f& pixel) {
    const double z = depth.at<float>(y, x);
    const double weight = weights.empty() ? 1.0 : weights.at<float>(y, x);
    if (z == 0.0 || !(weight > 0.0 && weight <= 1.0)) return;
    const cv::Vec3d normal = normals.at<cv::Vec3f>(y, x);
    const cv::Vec3d ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0);
    const bool edge = normal[2] == 0.0;
    const double cosine = edge ? 1.0 : std::clamp<double>(-normal.dot(ray) / cv::norm(ray), MIN_COSINE, 1.0);
    const double lateral_m = lateral_px * z / camera.fx * std::tan(std::acos(cosine));
    const double sigma = edge ? edge_sigmas * sensorSigma(z) : std::hypot(sensorSigma(z), lateral_m);
    pixel = cv::Vec3d(z, cosine, sensorSigma(z) / sigma * std::sqrt(weight));
  });
  return result;
}

inline uint32_t packedMeasurement(const cv::Vec3f& measured, double depth_step_m) {
  if (measured[0] == 0.0f) return 0;
  const auto code = [](float fraction) {
    return static_cast<uint32_t>(
        std::clamp(std::lround(fraction * MEASUREMENT_MAX), 1l, 1l * MEASUREMENT_MAX));
  };
  const auto depth = static_cast<uint32_t>(std::lround(measured[0] / depth_step_m));
  return depth << (2 * MEASUREMENT_BITS) | code(measured[1]) << MEASUREMENT_BITS | code(measured[2]);
}

inline cv::Vec3f unpackedMeasurement(uint32_t word, double depth_step_m) {
  const uint32_t mask = MEASUREMENT_MAX;
  return {static_cast<float>((word >> (2 * MEASUREMENT_BITS)) * depth_step_m),
          static_cast<float>(word >> MEASUREMENT_BITS & mask) / MEASUREMENT_MAX,
          static_cast<float>(word & mask) / MEASUREMENT_MAX};
}

inline std::vector<float> maxTiles(const cv::Mat& depth, int tile = DEPTH_TILE) {
  const int columns = (depth.cols + tile - 1) / tile;
  std::vector<float> tiles(columns * ((depth.rows + tile - 1) / tile), 0.0f);
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      float& largest = tiles[y / tile * columns + x / tile];
      largest = std::max(largest, depth.at<float>(y, x));
    }
  }
  return tiles;
}

}  // namespace depth_fusion::reference
