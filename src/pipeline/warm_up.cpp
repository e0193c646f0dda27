#include "depth_fusion/pipeline/warm_up.h"

#include <algorithm>
#include <cmath>

#include "depth_fusion/pipeline/reconstruction_pipeline.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kCamera{160, 120, 130.0, 130.0, 79.5, 59.5};
constexpr int kFrames = 3;  // the first begins, the second is tracked, the third has a velocity

// The wall has bumps that it can be tracked by.
RgbdFrame wallAt(float depth_m) {
  RgbdFrame frame;
  frame.intrinsics = kCamera;
  frame.depth_unit_m = 1e-4;
  frame.depth.create(kCamera.height, kCamera.width, CV_16UC1);
  for (int y = 0; y < kCamera.height; ++y) {
    for (int x = 0; x < kCamera.width; ++x) {
      const double bumps = 1.0 + 0.05 * std::sin(0.07 * x) + 0.05 * std::cos(0.09 * y);
      frame.depth.at<uint16_t>(y, x) = cv::saturate_cast<uint16_t>(depth_m * bumps / frame.depth_unit_m);
    }
  }
  frame.color = cv::Mat::zeros(kCamera.height, kCamera.width, CV_8UC3);
  return frame;
}

}  // namespace

void warmUp(ComputeContext& compute, PipelineParameters parameters) {
  parameters.map.blocks_per_axis = 16;
  parameters.map.pool_mib = 1;
  parameters.icp_tracking.min_inliers = 6;
  const PreprocessingParameters& range = parameters.preprocessing;
  ReconstructionPipeline pipeline(compute, parameters, kCamera);
  RgbdFrame frame =
      wallAt(std::min(range.min_range_m + 0.2f, 0.5f * (range.min_range_m + range.max_range_m)));
  for (int i = 0; i < kFrames; ++i) {
    frame.stamp_s = i / 30.0;
    pipeline.processFrame(frame);
  }
}

}  // namespace depth_fusion
