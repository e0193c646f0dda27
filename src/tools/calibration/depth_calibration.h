// The systematic errors of a depth sensor from a recording of an ordinary scene, without a target and without
// known poses: planes must be flat, and what two frames see must coincide. docs/calibration.md says what can
// be known from that.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "depth_fusion/compute/compute_context.h"
#include "depth_fusion/frames/rgbd_frame.h"
#include "depth_fusion/pipeline/pipeline_parameters.h"

namespace depth_fusion {

struct Estimate {
  double value = 0.0;
  double sigma = 0.0;  // standard deviation
};

// The parts of a calibration, each applied or held at its default as a whole.
enum class CalibrationPart {
  kMean,     // of the depth offsets
  kTilt,     // what of them grows along rows and columns
  kShape,    // the rest of them
  kReadout,  // of the rolling shutter
};
constexpr int kPartCount = 4;

struct PartVerdict {
  bool applied = false;
  // By how many standard deviations frames fit better with it that it was not estimated from.
  double gain_sigmas = 0.0;
};

struct CalibrationFrame {
  RgbdFrame frame;                       // its colour is not used
  Pose T_W_D = Pose::Identity();         // as tracked, good to a few centimetres
  Vector6d velocity = Vector6d::Zero();  // of D in D, per second
};

// Says how far planes are from flat, before or after the correction, apart from noise.
struct DepthResiduals {
  cv::Mat
      map_per_m;  // CV_32FC1: what their inverse depth lacks, by part of the image; NaN where there are none
  double rms_per_m = 0.0;
};

struct DepthCalibration {
  cv::Mat offsets_per_m;           // of the inverse depth (depth_correction.h), of the applied parts alone
  cv::Mat sigmas_per_m;            // their standard deviations, for each offset
  int observed_offsets = 0;        // those that the recording, and not the prior alone, determines
  std::vector<PartVerdict> parts;  // by CalibrationPart
  Estimate readout_s;              // the given one if it is not applied
  bool readout_observed = false;
  int pairs = 0;   // of frames that see the same surface
  int planes = 0;  // in all frames
  DepthResiduals before, after;
};

inline bool isApplied(const DepthCalibration& calibration, CalibrationPart part) {
  return calibration.parts[static_cast<size_t>(part)].applied;
}

// Finds the depth offsets and the readout that make the frames fit best. The frames are in the order of time.
// The parameters say the sensor's noise, range, stamp delay and a first readout. Throws Error, which says
// why, if the frames determine no offset.
DepthCalibration calibrateDepth(ComputeContext& compute, const PipelineParameters& parameters,
                                const std::vector<CalibrationFrame>& frames);

}  // namespace depth_fusion
