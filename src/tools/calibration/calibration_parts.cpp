#include "tools/calibration/calibration_parts.h"

#include <algorithm>
#include <cmath>

namespace depth_fusion {
namespace {

// The weight that holds a parameter at its default.
constexpr double kHeld = 1e10;
// The method itself is off by these, as simulated recordings show; no uncertainty is smaller.
constexpr double kMethodOffsetSigma_per_m = 0.0015;
constexpr double kMethodReadoutSigma_s = 0.0015;

using Directions = Eigen::Matrix<double, kParameterCount, Eigen::Dynamic>;

// The offsets that are the same everywhere, and those that grow along the rows and along the columns.
Directions projectiveDirections() {
  Directions directions = Directions::Zero(kParameterCount, 3);
  for (int row = 0; row < kGridRows; ++row) {
    for (int column = 0; column < kGridColumns; ++column) {
      directions.row(row * kGridColumns + column) << 1.0, column - (kGridColumns - 1) / 2.0,
          row - (kGridRows - 1) / 2.0;
    }
  }
  return directions.colwise().normalized();
}

// Returns the projection onto the part's parameters.
ParameterMatrix projection(CalibrationPart part) {
  static const Directions directions = projectiveDirections();
  ParameterMatrix result = ParameterMatrix::Zero();
  if (part == CalibrationPart::kReadout) {
    result(kReadoutIndex, kReadoutIndex) = 1.0;
  } else if (part == CalibrationPart::kMean) {
    result = directions.leftCols<1>() * directions.leftCols<1>().transpose();
  } else if (part == CalibrationPart::kTilt) {
    result = directions.rightCols<2>() * directions.rightCols<2>().transpose();
  } else {
    result.diagonal().head<kReadoutIndex>().setOnes();
    result -= directions * directions.transpose();
  }
  return result;
}

}  // namespace

SegmentedSystem::SegmentedSystem(const std::vector<NormalEquations>& segments, const ParameterMatrix& prior,
                                 const ParameterVector& at, const ParameterVector& defaults)
    : segments_(segments), prior_(prior), at_(at), defaults_(defaults) {
  for (const NormalEquations& segment : segments) sum_.add(segment);
}

ParameterMatrix SegmentedSystem::hessianOf(const NormalEquations& sum, const Free& free) const {
  ParameterMatrix hessian = sum.hessian + prior_;
  for (int part = 0; part < kPartCount; ++part) {
    if (!free[part]) hessian += kHeld * projection(static_cast<CalibrationPart>(part));
  }
  return hessian;
}

ParameterVector SegmentedSystem::solution(const Free& free, int left_out) const {
  NormalEquations sum = sum_;
  if (left_out >= 0) {
    sum.hessian -= segments_[left_out].hessian;
    sum.gradient -= segments_[left_out].gradient;
  }
  const ParameterVector gradient = sum.gradient + sum.hessian * (defaults_ - at_);
  return defaults_ - Eigen::LDLT<ParameterMatrix>(hessianOf(sum, free)).solve(gradient);
}

double SegmentedSystem::cost(int segment, const ParameterVector& parameters) const {
  const ParameterVector step = parameters - at_;
  return segments_[segment].gradient.dot(step) + 0.5 * step.dot(segments_[segment].hessian * step);
}

std::vector<double> SegmentedSystem::heldOutCosts(const Free& free) const {
  std::vector<double> costs;
  for (int segment = 0; segment < static_cast<int>(segments_.size()); ++segment)
    costs.push_back(cost(segment, solution(free, segment)));
  return costs;
}

double SegmentedSystem::gain_sigmas(const Free& free, int part, const std::vector<double>& costs) const {
  Free without = free;
  without[part] = false;
  const std::vector<double> costs_without = heldOutCosts(without);
  const auto count = static_cast<double>(costs.size());
  double sum = 0.0, squares = 0.0;
  for (size_t i = 0; i < costs.size(); ++i) {
    const double gain = costs_without[i] - costs[i];
    sum += gain;
    squares += gain * gain;
  }
  const double variance = std::max(squares - sum * sum / count, 0.0) * count / (count - 1.0);
  return sum / std::max(std::sqrt(variance), 1e-12);
}

std::vector<PartVerdict> SegmentedSystem::verdicts() const {
  std::vector<PartVerdict> result(kPartCount);
  Free free;
  free.fill(true);
  while (true) {
    const std::vector<double> costs = heldOutCosts(free);
    int worst = -1;
    for (int part = 0; part < kPartCount; ++part) {
      if (!free[part]) continue;
      result[part] = {true, gain_sigmas(free, part, costs)};
      if (result[part].gain_sigmas < kMinGain_sigmas &&
          (worst < 0 || result[part].gain_sigmas < result[worst].gain_sigmas))
        worst = part;
    }
    if (worst < 0) return result;
    free[worst] = result[worst].applied = false;
  }
}

ParameterVector SegmentedSystem::solution(const std::vector<PartVerdict>& verdicts) const {
  Free free;
  for (int part = 0; part < kPartCount; ++part) free[part] = verdicts[part].applied;
  return solution(free, -1);
}

ParameterVector SegmentedSystem::sigmas() const {
  Free free;
  free.fill(true);
  const Eigen::LDLT<ParameterMatrix> solver(hessianOf(sum_, free));
  const ParameterVector step = solution(free, -1) - at_;
  const auto count = static_cast<double>(segments_.size());
  ParameterMatrix scatter = prior_;
  for (const NormalEquations& segment : segments_) {
    const ParameterVector pull = segment.gradient + segment.hessian * step;
    scatter += count / (count - 1.0) * pull * pull.transpose();
  }
  const ParameterMatrix covariance = solver.solve(solver.solve(scatter).transpose());
  ParameterVector method = ParameterVector::Constant(kMethodOffsetSigma_per_m);
  method[kReadoutIndex] = kMethodReadoutSigma_s;
  return (covariance.diagonal().cwiseMax(0.0) + method.cwiseAbs2()).cwiseSqrt();
}

}  // namespace depth_fusion
