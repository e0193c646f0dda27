// One frame's way through all the stages.
#pragma once

#include <future>

#include "depth_fusion/pipeline/frame_tracker.h"
#include "depth_fusion/pipeline/mapper.h"
#include "depth_fusion/pipeline/posed_preprocessor.h"

namespace depth_fusion {

struct FrameResult {
  TrackingResult tracking;
  FusionResult fusion;  // all zero if the frame was not fused
  ColorFusionResult color;
};

// Tracks and fuses frame by frame. W is the first fused frame's camera frame, or that of the given
// poses.
class ReconstructionPipeline {
 public:
  ReconstructionPipeline(ComputeContext& compute, const PipelineParameters& parameters,
                         const CameraIntrinsics& camera);

  // A lost frame changes nothing in the map. `next` is the frame that the next call is for, if it is there
  // already: its texture odometry runs on a thread of its own meanwhile.
  FrameResult processFrame(const RgbdFrame& frame, const RgbdFrame* next = nullptr);

  // The same with a pose from elsewhere in place of tracking; lost only if there is no depth.
  FrameResult processFrame(const RgbdFrame& frame, const Pose& T_W_D);

  BlockSparseMap& map() { return map_; }
  StageTimers& timers() { return timers_; }
  const PipelineParameters& parameters() const { return parameters_; }
  size_t keyframeCount() const { return tracker_.keyframeCount(); }

 private:
  // A frame's features, and its motion against the frame before.
  struct TexturedFrame {
    FrameFeatures features;
    TextureOdometryResult motion;
    double milliseconds = 0.0;
  };

  TexturedFrame findMotion(const RgbdFrame& frame);
  // Lost if nothing could be fused.
  void fuse(const RgbdFrame& frame, const DepthFrame& depth, FrameResult& result);

  ComputeContext& compute_;
  PipelineParameters parameters_;
  StageTimers timers_;
  BlockSparseMap map_;
  TextureOdometry odometry_;
  std::future<TexturedFrame> next_;  // valid if the last call was given a next frame
  Mapper mapper_;
  FrameTracker tracker_;
  std::unique_ptr<PosedPreprocessor>
      posed_preprocessor_;           // made for the first frame with a pose from elsewhere
  const ModelView* view_ = nullptr;  // of the last fused frame; none before the first
};

}  // namespace depth_fusion
