// Depth preprocessing: metres, motion compensation, bilateral filter, pyramid, normals.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "depth_fusion/common/stage_timers.h"
#include "depth_fusion/compute/compute_context.h"
#include "depth_fusion/compute/device_buffer.h"
#include "depth_fusion/compute/result_pool.h"
#include "depth_fusion/frames/depth_frame.h"
#include "depth_fusion/frames/depth_sensor.h"
#include "depth_fusion/frames/rgbd_frame.h"
#include "depth_fusion/preprocessing/preprocessing_parameters.h"

namespace depth_fusion {

class DepthPreprocessor {
 public:
  DepthPreprocessor(ComputeContext& compute, const PreprocessingParameters& parameters,
                    const CameraIntrinsics& camera, const DepthSensorParameters& sensor = {});
  ~DepthPreprocessor();

  // The frames to come are preprocessed by these. Throws as validateRange does, and changes nothing then.
  void setParameters(const PreprocessingParameters& parameters, const DepthSensorParameters& sensor);
  // `velocity` is the sensor's in its own frame D: rotation (rad/s), translation (m/s). With it the depth
  // becomes that of the moment of the stamp (parameters readout_s, stamp_delay_s). The result stays valid
  // until the next call. If the first frame has far more noise than the sensor model says, the model is
  // raised to that, in this frame and the others (DepthLevel::sensor). Throws Error if depth or weights have
  // another type or size than expected.
  const DepthFrame& process(const RgbdFrame& frame, const Vector6d& velocity = Vector6d::Zero());
  // Does the same as a step of a frame's way: it is timed, and done when the call returns.
  const DepthFrame& process(const RgbdFrame& frame, const Vector6d& velocity, StageTimers& timers);
  // Returns the last result, which stays valid and unchanged for as long as it is held.
  std::shared_ptr<const DepthFrame> result() const { return results_.current(); }

 private:
  struct Kernels;

  void uploadWeights(const cv::Mat& weights);
  void uploadOffsets();

  ComputeContext& compute_;
  PreprocessingParameters parameters_;  // with the range that the sensor's noise allows
  DepthSensorParameters sensor_;
  std::optional<DepthSensorParameters> noise_;  // the sensor with the noise that it was seen to have
  DeviceBuffer input_;
  DeviceBuffer skewed_depth_;
  DeviceBuffer weights_;  // empty until a frame has some
  DeviceBuffer offsets_;  // of the inverse depth; empty without a correction
  ResultPool<DepthFrame> results_;
  std::unique_ptr<Kernels> kernels_;
};

}  // namespace depth_fusion
