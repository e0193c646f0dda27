#include "texture_odometry/motion_estimation.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "texture_odometry/motion_system.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

constexpr size_t kSampleSize = 3;
constexpr double kConfidence = 0.9999;
constexpr int kSampleIterations = 5;
constexpr int kRounds = 3;
constexpr int kIterationsPerRound = 6;
constexpr double kMinPixelScale = 0.03;
constexpr double kMinDepthScale = 0.3;

std::vector<size_t> inliersOf(const MotionModel& model, const InlierGate& gate,
                              const Pose& T_reference_current) {
  std::vector<size_t> inliers;
  for (size_t i = 0; i < model.correspondences().size(); ++i) {
    if (model.residuals(i, T_reference_current).within(gate)) inliers.push_back(i);
  }
  return inliers;
}

std::vector<size_t> drawSample(std::mt19937& random, size_t count) {
  std::vector<size_t> sample;
  while (sample.size() < kSampleSize) {
    const size_t index = random() % count;
    if (std::find(sample.begin(), sample.end(), index) == sample.end()) sample.push_back(index);
  }
  return sample;
}

// The motion that the points alone tell, where all have depth twice; it is a start for what the pixels
// refine.
Pose alignPoints(const std::vector<Correspondence>& correspondences, const std::vector<size_t>& sample) {
  Eigen::Matrix3d reference, current;
  for (size_t i = 0; i < kSampleSize; ++i) {
    const Correspondence& pair = correspondences[sample[i]];
    if (!pair.reference.point || !pair.current.point) return Pose::Identity();
    reference.col(static_cast<int>(i)) = *pair.reference.point;
    current.col(static_cast<int>(i)) = *pair.current.point;
  }
  return Pose(Eigen::umeyama(current, reference, false));
}

// Returns how many samples it takes to have one without outliers.
int neededIterations(size_t inliers, size_t count) {
  const double good = std::pow(static_cast<double>(inliers) / static_cast<double>(count), kSampleSize);
  if (good >= 1.0) return 1;
  return static_cast<int>(std::min(1e6, std::ceil(std::log(1.0 - kConfidence) / std::log(1.0 - good))));
}

double medianOf(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Estimates the standard deviations of the inliers' residuals robustly: the squared norm of two normal values
// has the median 1.386.
NoiseScale noiseOf(const MotionModel& model, const std::vector<size_t>& inliers,
                   const Pose& T_reference_current) {
  std::vector<double> pixels, depth;
  for (const size_t index : inliers) {
    const MotionResiduals residual = model.residuals(index, T_reference_current);
    pixels.push_back((residual.in_reference ? residual.in_reference : residual.in_current)->squaredNorm());
    if (residual.depth) depth.push_back(std::abs(*residual.depth));
  }
  NoiseScale noise;
  noise.pixels = std::max(kMinPixelScale, std::sqrt(medianOf(pixels) / 1.386));
  if (!depth.empty()) noise.depth = std::max(kMinDepthScale, 1.4826 * medianOf(depth));
  return noise;
}

// By how much all inliers may be off alike, in standard deviations of their mean. Their residuals do not show
// it: colour and depth of different moments, and rows read one after the other, move a whole image by a part
// of how far it moves anyway.
double sharedErrorSigmas(const std::vector<Correspondence>& correspondences,
                         const std::vector<size_t>& inliers, const NoiseScale& noise, double shared_error) {
  std::vector<double> shifts, sigmas;
  for (const size_t index : inliers) {
    const Correspondence& pair = correspondences[index];
    shifts.push_back((pair.current.pixel - pair.reference.pixel).norm());
    sigmas.push_back(pair.sigma_px);
  }
  const double sigma_of_mean_px =
      noise.pixels * medianOf(sigmas) / std::sqrt(static_cast<double>(inliers.size()));
  return shared_error * medianOf(shifts) / sigma_of_mean_px;
}

}  // namespace

std::optional<MotionEstimate> estimateByRansac(const std::vector<Correspondence>& correspondences,
                                               const MotionCameras& cameras, const InlierGate& gate,
                                               int max_iterations) {
  if (correspondences.size() < kSampleSize) return std::nullopt;
  const MotionModel model(correspondences, cameras);
  std::mt19937 random(1);
  std::optional<MotionEstimate> best;
  int needed = max_iterations;
  for (int i = 0; i < needed; ++i) {
    const std::vector<size_t> sample = drawSample(random, correspondences.size());
    const std::optional<Pose> T_reference_current =
        solveMotion(model, sample, {}, alignPoints(correspondences, sample), kSampleIterations);
    if (!T_reference_current) continue;
    std::vector<size_t> inliers = inliersOf(model, gate, *T_reference_current);
    if (inliers.size() <= (best ? best->inliers.size() : kSampleSize)) continue;
    needed = std::min(max_iterations, neededIterations(inliers.size(), correspondences.size()));
    best = MotionEstimate{*T_reference_current, Matrix6d::Zero(), std::move(inliers)};
  }
  return best;
}

std::optional<MotionEstimate> refineMotion(const std::vector<Correspondence>& correspondences,
                                           const MotionCameras& cameras, const InlierGate& gate,
                                           const Pose& start, double shared_error) {
  const MotionModel model(correspondences, cameras);
  MotionEstimate estimate;
  estimate.T_reference_current = start;
  NoiseScale noise;
  for (int round = 0; round < kRounds; ++round) {
    estimate.inliers = inliersOf(model, gate, estimate.T_reference_current);
    if (estimate.inliers.size() < kSampleSize) return std::nullopt;
    noise = noiseOf(model, estimate.inliers, estimate.T_reference_current);
    const std::optional<Pose> refined =
        solveMotion(model, estimate.inliers, noise, estimate.T_reference_current, kIterationsPerRound);
    if (!refined) return std::nullopt;
    estimate.T_reference_current = *refined;
  }
  MotionSystem system;
  for (const size_t index : estimate.inliers)
    model.accumulate(index, estimate.T_reference_current, noise, system);
  const double shared = sharedErrorSigmas(correspondences, estimate.inliers, noise, shared_error);
  estimate.covariance = (1.0 + shared * shared) * system.hessian.inverse();
  return estimate;
}

}  // namespace depth_fusion
