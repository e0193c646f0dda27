// Depth preprocessing: metres, motion compensation, bilateral filter, pyramid, normals.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "depth_fusion/common/parameters.h"
#include "depth_fusion/compute/compute_context.h"
#include "depth_fusion/compute/device_buffer.h"
#include "depth_fusion/compute/result_pool.h"
#include "depth_fusion/preprocessing/depth_sensor.h"
#include "depth_fusion/recording/rgbd_frame.h"

namespace depth_fusion {

struct PreprocessingParameters {
  float min_range_m = 0.3f;
  float max_range_m = 5.0f;
  std::string depth_offsets_per_m;  // parseDepthOffsets reads it
  float readout_s = 0.0f;
  float stamp_delay_s = 0.0f;
  float bilateral_sigma_px = 1.5f;
  float bilateral_cutoff_sigmas = 3.0f;
  float max_relative_step = 0.05f;

  ParameterTable table();
};

// Throws Error if a parameter lies outside its range, or no depth in the range of both.
void validateRange(const PreprocessingParameters& parameters, const DepthSensorParameters& sensor);

// A level of the pyramid, on the device (image layout: kernels/shared/types.h).
struct DepthLevel {
  CameraIntrinsics camera;
  DeviceBuffer depth;  // metres, 0 = none
  DeviceBuffer
      normals;  // unit normals towards the camera in frame D, packed (kernels/shared/normal.h), 0 = none
  DepthSensorParameters sensor = {};  // the depth's noise
};

struct DepthFrame {
  DeviceBuffer raw_depth;  // metres in range, motion compensated, unfiltered, 0 = none; camera of levels[0]
  DeviceBuffer max_tiles;  // the largest raw depth of each 8x8 tile, row by row
  DeviceBuffer measurements;       // what fusion needs of levels[0]: a word a pixel (kernels/shared/types.h)
  float depth_step_m = 0.0f;       // of the measurements
  std::vector<DepthLevel> levels;  // filtered; full size first, each half the size of the one before

  // The farthest depth that measurements hold.
  float maxRange_m() const;
};

class DepthPreprocessor {
 public:
  static constexpr int kLevels = 3;

  DepthPreprocessor(ComputeContext& compute, const PreprocessingParameters& parameters,
                    const CameraIntrinsics& camera, const DepthSensorParameters& sensor = {});
  ~DepthPreprocessor();

  // For the frames to come. Throws as validateRange does, and changes nothing then.
  void setParameters(const PreprocessingParameters& parameters, const DepthSensorParameters& sensor);
  // `velocity` is the sensor's in its own frame D: rotation (rad/s), translation (m/s); with it the depth
  // becomes that of the moment of the stamp (parameters readout_s, stamp_delay_s). The result stays valid
  // until the next call. Throws Error if the type or size of depth or weights is not the expected.
  const DepthFrame& process(const RgbdFrame& frame, const Vector6d& velocity = Vector6d::Zero());
  // The last result, valid and unchanged for as long as it is held.
  std::shared_ptr<const DepthFrame> result() const { return results_.current(); }

 private:
  struct Kernels;

  void uploadWeights(const cv::Mat& weights);
  void uploadOffsets();

  ComputeContext& compute_;
  PreprocessingParameters parameters_;  // with the range that the sensor's noise allows
  DepthSensorParameters sensor_;
  DeviceBuffer input_;
  DeviceBuffer skewed_depth_;
  DeviceBuffer weights_;  // empty until a frame has some
  DeviceBuffer offsets_;  // of the inverse depth; empty without a correction
  ResultPool<DepthFrame> results_;
  std::unique_ptr<Kernels> kernels_;
};

}  // namespace depth_fusion
