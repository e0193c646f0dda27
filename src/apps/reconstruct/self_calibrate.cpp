#include "apps/reconstruct/self_calibrate.h"

#include <algorithm>
#include <iostream>

#include "depth_fusion/common/error.h"
#include "depth_fusion/registration/registered_recording.h"
#include "ros/bags/open_recording.h"
#include "tools/calibration/self_calibration.h"

namespace depth_fusion {
namespace {

constexpr size_t kMaxFrames = 1000;  // half a minute

SelfCalibration calibrated(const RunOptions& options) {
  ComputeContext compute(options.device);
  const auto open = [&] {
    return registered(openRecordings(options.inputs, options.recording), compute,
                      options.parameters.registration);
  };
  const size_t count = options.max_frames == 0 ? kMaxFrames : std::min(kMaxFrames, options.max_frames);
  return calibrateFrom(compute, open, options.parameters, {0, count},
                       [](const std::string& text) { std::cout << "calibrating: " << text << std::endl; });
}

}  // namespace

RunOptions selfCalibrated(const RunOptions& options) {
  RunOptions result = options;
  try {
    const SelfCalibration calibration = calibrated(options);
    std::cout << calibrationText(calibration) << std::flush;
    result.parameters = calibration.corrected;
  } catch (const Error& error) {
    std::cout << "not calibrated: " << error.what() << "; the depth is used as it is" << std::endl;
  }
  return result;
}

}  // namespace depth_fusion
