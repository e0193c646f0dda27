// The calibration's parts: those that the frames confirm are applied, the others are held at their defaults.
#pragma once

#include "tools/calibration/calibration_system.h"
#include "tools/calibration/depth_calibration.h"

namespace depth_fusion {

// A part is applied if the segments that it was not estimated from gain by it, by so many standard deviations
// of the gain.
constexpr double kMinGain_sigmas = 2.0;

// The equations of several stretches of the recording, and what is known beforehand.
class SegmentedSystem {
 public:
  // The segments are linearised at `at`; the prior pulls towards the defaults.
  SegmentedSystem(const std::vector<NormalEquations>& segments, const ParameterMatrix& prior,
                  const ParameterVector& at, const ParameterVector& defaults);

  // Says for each part whether it makes frames fit better that it was not estimated from. What does not is
  // held, the worst first.
  std::vector<PartVerdict> verdicts() const;
  // The best parameters, with those parts that the verdicts refuse at their defaults.
  ParameterVector solution(const std::vector<PartVerdict>& verdicts) const;
  // Standard deviations of all parameters, held or not, from how much the segments contradict each other.
  ParameterVector sigmas() const;

 private:
  // Which parts are free to differ from their defaults.
  using Free = std::array<bool, kPartCount>;

  ParameterMatrix hessianOf(const NormalEquations& sum, const Free& free) const;
  // The best parameters of all segments but one; -1 leaves none out.
  ParameterVector solution(const Free& free, int left_out) const;
  // By how much the parameters change a segment's cost.
  double cost(int segment, const ParameterVector& parameters) const;
  // What each segment costs under the parameters of the others.
  std::vector<double> heldOutCosts(const Free& free) const;
  // By how many standard deviations the segments cost more with the part held.
  double gain_sigmas(const Free& free, int part, const std::vector<double>& costs) const;

  const std::vector<NormalEquations>& segments_;
  NormalEquations sum_;
  const ParameterMatrix& prior_;
  ParameterVector at_, defaults_;
};

}  // namespace depth_fusion
