
#include "common/io/formatted_line.h"
#include "tools/calibration/calibration_parts.h"
#include "tools/calibration/self_calibration.h"

namespace depth_fusion {
namespace {

std::string offsetsText(const DepthCalibration& depth) {
  double least = 0.0, largest = 0.0;
  cv::minMaxLoc(depth.offsets_per_m, &least, &largest);
  const int total = static_cast<int>(depth.offsets_per_m.total());
  return line("depth offsets: %+.1f to %+.1f mm at 1 m, give or take %.1f; %d of %d are determined",
              1e3 * least, 1e3 * largest, 1e3 * cv::mean(depth.sigmas_per_m)[0], depth.observed_offsets,
              total) +
         (depth.planes > 0 ? line("  planes are flat to %.1f mm RMS at 1 m before, to %.1f after",
                                  1e3 * depth.before.rms_per_m, 1e3 * depth.after.rms_per_m)
                           : line("  no plane was seen"));
}

std::string partText(const DepthCalibration& depth, CalibrationPart part, const char* name) {
  const PartVerdict& verdict = depth.parts[static_cast<int>(part)];
  return verdict.applied
             ? line("  %s: applied; frames that were left out fit better by it, by %.1f sigma", name,
                    verdict.gain_sigmas)
             : line("  %s: not applied; frames that were left out gain %.1f sigma by it, and %.0f are needed",
                    name, verdict.gain_sigmas, kMinGain_sigmas);
}

std::string readoutText(const DepthCalibration& depth) {
  const Estimate& readout = depth.readout_s;
  if (!depth.readout_observed)
    return line("readout: not known (+- %.0f ms), the sensor moves too slowly; left as it is",
                1e3 * readout.sigma);
  return line(isApplied(depth, CalibrationPart::kReadout)
                  ? "readout: %.1f +- %.1f ms from the first row to the last"
                  : "readout: left at %.1f ms; the frames tell it to +- %.1f ms",
              1e3 * readout.value, 1e3 * readout.sigma);
}

}  // namespace

std::string calibrationText(const SelfCalibration& calibration) {
  const DepthCalibration& depth = calibration.depth;
  std::string text = offsetsText(depth) + partText(depth, CalibrationPart::kMean, "their mean") +
                     partText(depth, CalibrationPart::kTilt, "their tilt") +
                     partText(depth, CalibrationPart::kShape, "their shape") + readoutText(depth);
  if (depth.readout_observed) text += partText(depth, CalibrationPart::kReadout, "it");
  return text +
         (calibration.refused
              ? line("NOTHING IS APPLIED: tracked again with it, the map explains the frames less well")
              : line("the map explains %.1f %% of a frame before, %.1f %% after",
                     1e2 * calibration.explained_before, 1e2 * calibration.tracked.explained));
}

}  // namespace depth_fusion
