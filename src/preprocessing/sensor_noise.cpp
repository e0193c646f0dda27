#include "depth_fusion/preprocessing/sensor_noise.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "shared/types.h"

namespace depth_fusion {
namespace {

constexpr int kSpacing_px = 2;   // of the neighbours
constexpr int kSampling_px = 4;  // from one sample to the next
constexpr size_t kBins = 8;      // of depth, with as many samples each
constexpr size_t kMinBinSamples = 100;
constexpr double kMuchNoise = 2.0;     // times the model's
constexpr double kLargestRise = 10.0;  // times the model's
// The median of |a - 2 b + c| of normal noise, over its sigma.
constexpr double kMedianOfDifference = 0.6745 * 2.449489743;

struct Sample {
  double depth_m, difference_m;
};

template <class Value>
void addSamples(const RgbdFrame& frame, const DepthRange& range, std::vector<Sample>& samples) {
  const cv::Mat& depth = frame.depth;
  const auto at = [&](int v, int u) {
    return static_cast<double>(depth.at<Value>(v, u)) * frame.depth_unit_m;
  };
  const auto inRange = [&](double z) { return z >= range.min_m && z <= range.max_m; };
  for (int v = kSpacing_px; v < depth.rows - kSpacing_px; v += kSampling_px) {
    for (int u = kSpacing_px; u < depth.cols - kSpacing_px; u += kSampling_px) {
      const double z = at(v, u);
      if (!inRange(z)) continue;
      for (const auto& [dv, du] : {std::pair(0, kSpacing_px), std::pair(kSpacing_px, 0)}) {
        const double before = at(v - dv, u - du), after = at(v + dv, u + du);
        if (!inRange(before) || !inRange(after)) continue;
        // The mean's noise has nothing to do with the difference's, so that bins of it are fair.
        samples.push_back({(before + z + after) / 3.0, std::abs(before - 2.0 * z + after)});
      }
    }
  }
}

// The sigma of samples at about the same depth.
Sample sigmaOf(std::vector<Sample>::iterator begin, std::vector<Sample>::iterator end) {
  const auto middle = begin + (end - begin) / 2;
  const double depth_m = middle->depth_m;  // they are in order of depth
  std::nth_element(begin, middle, end,
                   [](const Sample& a, const Sample& b) { return a.difference_m < b.difference_m; });
  return {depth_m, middle->difference_m / kMedianOfDifference};
}

// Fits base and growth to the sigmas, by least squares of their ratios to the model's.
DepthSensorParameters fitted(const std::vector<Sample>& sigmas, const DepthSensorParameters& model) {
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  for (const auto& [depth_m, sigma_m] : sigmas) {
    const double model_m = AXIAL_SIGMA_M(model, depth_m);
    const Eigen::Vector2d row =
        Eigen::Vector2d(1.0, std::pow(depth_m - static_cast<double>(model.sigma_from_m), 2)) / model_m;
    hessian += row * row.transpose();
    gradient += row * sigma_m / model_m;
  }
  const Eigen::Vector2d solution = hessian.ldlt().solve(gradient);
  const auto raised = [](double value, float of_model) {
    const double least = of_model;
    return static_cast<float>(std::isfinite(value) ? std::clamp(value, least, kLargestRise * least) : least);
  };
  DepthSensorParameters result = model;
  result.sigma_base_m = raised(solution(0), model.sigma_base_m);
  result.sigma_growth_per_m = raised(solution(1), model.sigma_growth_per_m);
  return result;
}

}  // namespace

std::optional<DepthSensorParameters> raisedToNoise(const RgbdFrame& frame, const DepthRange& range,
                                                   const DepthSensorParameters& model) {
  std::vector<Sample> samples;
  frame.depth.type() == CV_16UC1 ? addSamples<uint16_t>(frame, range, samples)
                                 : addSamples<float>(frame, range, samples);
  const size_t bin_samples = samples.size() / kBins;
  if (bin_samples < kMinBinSamples) return std::nullopt;
  std::sort(samples.begin(), samples.end(),
            [](const Sample& a, const Sample& b) { return a.depth_m < b.depth_m; });
  std::vector<Sample> sigmas;
  bool much_noise = false;
  for (size_t i = 0; i < kBins; ++i) {
    const auto begin = samples.begin() + static_cast<std::ptrdiff_t>(i * bin_samples);
    sigmas.push_back(sigmaOf(begin, begin + static_cast<std::ptrdiff_t>(bin_samples)));
    much_noise |= sigmas.back().difference_m > kMuchNoise * AXIAL_SIGMA_M(model, sigmas.back().depth_m);
  }
  return much_noise ? fitted(sigmas, model) : model;
}

std::string noiseRemark(const DepthSensorParameters& model, const DepthSensorParameters& used) {
  if (used.sigma_base_m == model.sigma_base_m && used.sigma_growth_per_m == model.sigma_growth_per_m)
    return "";
  char text[400];
  std::snprintf(
      text, sizeof(text),
      "depth has a sigma of %.1f mm at 1 m and %.1f mm at 3 m, where the sensor model says %.1f and "
      "%.1f; filters and gates follow what is seen: set depth_sensor/sigma_base_m: %.4f and "
      "depth_sensor/sigma_growth_per_m: %.4f, or take the sensor's preset",
      1e3 * AXIAL_SIGMA_M(used, 1.0), 1e3 * AXIAL_SIGMA_M(used, 3.0), 1e3 * AXIAL_SIGMA_M(model, 1.0),
      1e3 * AXIAL_SIGMA_M(model, 3.0), used.sigma_base_m, used.sigma_growth_per_m);
  return text;
}

}  // namespace depth_fusion
