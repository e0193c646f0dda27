// benchmark suite: a map in the middle of a recording, and each stage's work on the frame that comes next.
#pragma once

#include "apps/benchmark/tracking_inputs.h"
#include "depth_fusion/color_fusion/color_fusion.h"
#include "depth_fusion/registration/frame_registration.h"
#include "icp_tracking/icp_tracking_kernels.h"

namespace depth_fusion {

class StageFixture {
 public:
  // Fuses the input's first frames. Inputs are frozen: one that changes gets a new name, so that figures
  // under a name compare.
  StageFixture(ComputeContext& compute, const TrackingInput& input);

  struct Stage {
    std::string name;
    void (StageFixture::*run)();
    bool has_levels = false;  // its kernels run on the levels of a pyramid
    int level = -1;           // the only one that it works on, if it is one
  };
  static const std::vector<Stage>& stages();

  // Runs the stage once, as the pipeline does in a frame, and waits until it is done.
  void run(const Stage& stage);

  ComputeContext& compute() { return compute_; }
  StageTimers& timers() { return timers_; }  // of the parts of stages
  const CameraIntrinsics& camera() const { return frame_.intrinsics; }
  const MapParameters& mapParameters() { return pipeline_.map().parameters(); }

 private:
  void rectify();
  void moveDepth();
  void preprocess();
  void matchTexture();
  void track();
  template <int level>
  void accumulateLevel();
  void fuseDepth();
  void fuseColor();
  void renderView();
  void extractMesh();

  ComputeContext& compute_;
  StageTimers timers_;
  RgbdFrame frame_, next_frame_;  // the last that was fused, and the one after it
  ReconstructionPipeline pipeline_;
  Pose T_W_D_;                           // of frame_
  std::unique_ptr<BlockMap> fused_map_;  // as it is before fusion goes on, for the stages that read it
  PipelineParameters parameters_;
  RgbdFrame bent_frame_, beside_frame_;  // frame_ as if through lenses, and with the colour camera elsewhere
  FrameRegistration rectification_, depth_to_color_;
  DepthPreprocessor preprocessor_, next_preprocessor_;
  TextureOdometry odometry_;
  IcpTracker tracker_;
  IcpTracker::Kernels icp_kernels_;
  DeviceBuffer partial_sums_;
  TsdfFusion fusion_;
  ColorFusion color_fusion_;
  ModelViewRenderer renderer_, tracked_renderer_;
  size_t visible_count_ = 0;
  size_t matched_count_ = 0;
};

}  // namespace depth_fusion
