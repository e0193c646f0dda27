#include "tools/simulation/sensor_model.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace depth_fusion {
namespace {

// Draws normal noise of unit variance for every pixel, correlated over noise_width_px.
cv::Mat correlatedNoise(const cv::Size& size, double noise_width_px, uint64_t seed) {
  const int radius = static_cast<int>(std::ceil(3.0 * noise_width_px));
  cv::Mat noise(size + cv::Size(2 * radius, 2 * radius), CV_32FC1);
  cv::RNG random((seed + 1) * 0xd6e8feb86659fd93ull);
  random.fill(noise, cv::RNG::NORMAL, 0.0, 1.0);
  if (radius == 0) return noise;
  cv::Mat kernel = cv::getGaussianKernel(2 * radius + 1, noise_width_px, CV_32F);
  kernel /= cv::norm(kernel);
  cv::sepFilter2D(noise, noise, CV_32F, kernel, kernel);
  return noise(cv::Rect(cv::Point(radius, radius), size));
}

class RowSensor {
 public:
  RowSensor(const RenderedView& view, const SensorModel& sensor, const cv::Mat& noise, uint64_t seed, int row)
      : view_(view),
        sensor_(sensor),
        noise_(noise.ptr<float>(row)),
        random_((seed + 1) * 0x9e3779b97f4a7c15ull ^ (row + 1) * 0xbf58476d1ce4e5b9ull),
        row_(row) {
    random_.next();
  }

  float sense(int column) {
    const double jitter_u = random_.gaussian(sensor_.lateral_sigma_px);
    const double jitter_v = random_.gaussian(sensor_.lateral_sigma_px);
    const double chance = random_.uniform(0.0, 1.0);

    const int u = std::clamp(static_cast<int>(std::lround(column + jitter_u)), 0, view_.depth_m.cols - 1);
    const int v = std::clamp(static_cast<int>(std::lround(row_ + jitter_v)), 0, view_.depth_m.rows - 1);
    const double z_m = view_.depth_m.at<float>(v, u);
    if (z_m <= 0.0 || chance < dropout(u, v, z_m)) return 0.0f;
    const double sensed_m = quantised(z_m + noise_[column] * unquantisedSigma(z_m));
    return sensed_m >= sensor_.min_range_m && sensed_m <= sensor_.max_range_m ? static_cast<float>(sensed_m)
                                                                              : 0.0f;
  }

 private:
  double dropout(int u, int v, double z_m) const {
    const double flatness = 1.0 - view_.cos_incidence.at<float>(v, u) / std::max(sensor_.grazing_cos, 1e-9);
    return std::max(flatness, isEdge(u, v, z_m) ? sensor_.edge_dropout : 0.0);
  }

  bool isEdge(int u, int v, double z_m) const {
    for (const cv::Point step : {cv::Point(1, 0), cv::Point(-1, 0), cv::Point(0, 1), cv::Point(0, -1)}) {
      const cv::Point neighbour = cv::Point(u, v) + step;
      if (!neighbour.inside(cv::Rect({}, view_.depth_m.size()))) continue;
      if (std::abs(view_.depth_m.at<float>(neighbour) - z_m) > sensor_.edge_step * z_m) return true;
    }
    return false;
  }

  // Returns what the quantisation leaves of the axial sigma for other noise.
  double unquantisedSigma(double z_m) const {
    if (sensor_.disparity_step_px <= 0.0) return sensor_.axialSigma(z_m);
    const double step_m = z_m * z_m / sensor_.disparity_pxm * sensor_.disparity_step_px;
    return std::sqrt(std::max(0.0, std::pow(sensor_.axialSigma(z_m), 2) - step_m * step_m / 12.0));
  }

  double quantised(double z_m) const {
    if (sensor_.disparity_step_px <= 0.0) return z_m;
    const double steps = std::round(sensor_.disparity_pxm / z_m / sensor_.disparity_step_px);
    return sensor_.disparity_pxm / (steps * sensor_.disparity_step_px);
  }

  const RenderedView& view_;
  const SensorModel& sensor_;
  const float* noise_;
  cv::RNG random_;
  int row_;
};

}  // namespace

SensorModel kinectSensor() {
  SensorModel sensor;
  sensor.min_range_m = 0.4;
  sensor.max_range_m = 5.0;
  sensor.sigma_base_m = 0.0012;
  sensor.sigma_growth_per_m = 0.0019;
  sensor.sigma_from_m = 0.4;
  sensor.noise_width_px = 1.6;
  sensor.disparity_pxm = 580.0 * 0.075;
  sensor.disparity_step_px = 0.125;
  sensor.lateral_sigma_px = 0.4;
  sensor.edge_dropout = 0.6;
  sensor.grazing_cos = 0.2;
  return sensor;
}

SensorModel precisionSensor() {
  SensorModel sensor;
  sensor.min_range_m = 0.15;
  sensor.max_range_m = 1.0;
  sensor.sigma_base_m = 0.00005;
  sensor.sigma_growth_per_m = 0.00055;
  sensor.lateral_sigma_px = 0.2;
  sensor.edge_dropout = 0.6;
  sensor.grazing_cos = 0.2;
  return sensor;
}

SensorModel partScanner() {
  SensorModel sensor;
  sensor.camera = {640, 480, 1650.0, 1650.0, 319.5, 239.5};
  sensor.depth_unit_m = 0.00001;
  sensor.min_range_m = 0.2;
  sensor.max_range_m = 0.5;
  sensor.sigma_base_m = 0.00005;
  sensor.sigma_growth_per_m = 0.0002;
  sensor.sigma_from_m = 0.2;
  sensor.noise_width_px = 0.6;
  sensor.lateral_sigma_px = 0.2;
  sensor.edge_step = 0.005;
  sensor.edge_dropout = 0.6;
  sensor.grazing_cos = 0.2;
  return sensor;
}

cv::Mat senseDepth(const RenderedView& view, const SensorModel& sensor, uint64_t seed) {
  const cv::Mat noise = correlatedNoise(view.depth_m.size(), sensor.noise_width_px, seed);
  cv::Mat depth_m(view.depth_m.size(), CV_32FC1);
  cv::parallel_for_(cv::Range(0, depth_m.rows), [&](const cv::Range& rows) {
    for (int row = rows.start; row < rows.end; ++row) {
      RowSensor row_sensor(view, sensor, noise, seed, row);
      for (int column = 0; column < depth_m.cols; ++column) {
        depth_m.at<float>(row, column) = row_sensor.sense(column);
      }
    }
  });
  return depth_m;
}

cv::Mat idealDepth(const RenderedView& view, const SensorModel& sensor) {
  cv::Mat depth_m = view.depth_m.clone();
  depth_m.setTo(0.0f, (depth_m < sensor.min_range_m) | (depth_m > sensor.max_range_m));
  return depth_m;
}

}  // namespace depth_fusion
