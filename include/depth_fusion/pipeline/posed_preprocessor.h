// Preprocessing of frames whose poses are known from elsewhere.
#pragma once

#include <optional>

#include "depth_fusion/common/stage_timers.h"
#include "depth_fusion/pipeline/pipeline_parameters.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"

namespace depth_fusion {

class PosedPreprocessor {
 public:
  PosedPreprocessor(ComputeContext& compute, const PipelineParameters& parameters,
                    const CameraIntrinsics& camera)
      : compute_(compute),
        preprocessor_(compute, parameters.preprocessing, camera, parameters.depth_sensor) {}

  // For the frames to come. Throws Error if they do not fit together.
  void setParameters(const PipelineParameters& parameters) {
    preprocessor_.setParameters(parameters.preprocessing, parameters.depth_sensor);
  }
  // The sensor's velocity is that from the frame before to T_W_D. Valid until the next call.
  const DepthFrame& process(const RgbdFrame& frame, const Pose& T_W_D, StageTimers& timers);

 private:
  ComputeContext& compute_;
  DepthPreprocessor preprocessor_;
  std::optional<StampedPose> before_;
};

}  // namespace depth_fusion
