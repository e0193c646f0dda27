#include "tools/calibration/self_calibration.h"

#include "depth_fusion/preprocessing/depth_correction.h"

namespace depth_fusion {
namespace {

// A readout that is fewer standard deviations from 0 is that of a global shutter.
constexpr double kReadoutSigmas = 3.0;

bool hasOffsets(const DepthCalibration& depth) {
  return isApplied(depth, CalibrationPart::kMean) || isApplied(depth, CalibrationPart::kTilt) ||
         isApplied(depth, CalibrationPart::kShape);
}

PreprocessingParameters corrected(const DepthCalibration& depth, PreprocessingParameters parameters) {
  if (hasOffsets(depth)) parameters.depth_offsets_per_m = depthOffsetsText(depth.offsets_per_m);
  if (!isApplied(depth, CalibrationPart::kReadout)) return parameters;
  const Estimate& readout = depth.readout_s;
  parameters.readout_s =
      readout.value > kReadoutSigmas * readout.sigma ? static_cast<float>(readout.value) : 0.0f;
  return parameters;
}

// A second opinion: the tracker's own map, of all frames and not only of those that were calibrated from.
bool fitsWorse(const TrackedRecording& before, const TrackedRecording& after) {
  return after.explained < before.explained || after.trajectory.size() < before.trajectory.size();
}

}  // namespace

SelfCalibration calibrateFrom(ComputeContext& compute, const OpenRecording& open,
                              const PipelineParameters& parameters, const TrackingRange& range,
                              const Say& say) {
  SelfCalibration result;
  result.corrected = parameters;
  result.corrected.preprocessing.depth_offsets_per_m.clear();
  const PipelineParameters uncorrected = result.corrected;
  TrackedRecording before = track(compute, *open(), uncorrected, range, say);
  result.explained_before = before.explained;
  result.frames_used = before.frames.size();
  result.depth = calibrateDepth(compute, uncorrected, before.frames);
  result.corrected.preprocessing = corrected(result.depth, uncorrected.preprocessing);
  before.frames.clear();
  if (hasOffsets(result.depth) || isApplied(result.depth, CalibrationPart::kReadout)) {
    result.tracked = track(compute, *open(), result.corrected, range, say);
    result.refused = fitsWorse(before, result.tracked);
    if (!result.refused) return result;
  }
  result.corrected = uncorrected;
  result.tracked = std::move(before);
  return result;
}

}  // namespace depth_fusion
