// One frame's way through all the stages.
#pragma once

#include <future>

#include "depth_fusion/pipeline/frame_tracker.h"
#include "depth_fusion/pipeline/mapper.h"

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
  // already: its texture odometry runs beside this frame's stages, and its preprocessing beside this frame's
  // fusion and model view.
  FrameResult processFrame(const RgbdFrame& frame, const RgbdFrame* next = nullptr);

  // The same with a pose from elsewhere in place of tracking; lost only if there is no depth.
  FrameResult processFrame(const RgbdFrame& frame, const Pose& T_W_D);

  BlockMap& map() { return map_; }
  StageTimers& timers() { return timers_; }
  const PipelineParameters& parameters() const { return parameters_; }
  size_t keyframeCount() const { return tracker_.keyframeCount(); }

 private:
  // A frame's features, and its motion against the frame before.
  struct TexturedFrame {
    FrameFeatures features;
    TextureOdometryResult motion;
    StageTimers timers;
  };
  // With where it is expected; its depth is preprocessed.
  struct PreparedFrame : TexturedFrame {
    MotionPrior prior;
  };

  TexturedFrame findMotion(const RgbdFrame& frame);
  PreparedFrame prepare(const RgbdFrame& frame);
  // Lost if nothing could be fused.
  void fuse(const RgbdFrame& frame, const DepthFrame& depth, FrameResult& result);
  // Tells the tracker that a frame, which it was told is accepted, is not in the map.
  void withdraw();

  PipelineParameters parameters_;
  StageTimers timers_;
  BlockMap map_;
  TextureOdometry odometry_;
  Mapper mapper_;
  std::unique_ptr<ComputeContext> tracking_queue_;
  FrameTracker tracker_;
  const ModelView* view_ = nullptr;  // of the last fused frame; none before the first
  // Of the next frame; valid if the last call was given it.
  std::future<TexturedFrame> textured_;
  std::future<PreparedFrame> prepared_;
};

}  // namespace depth_fusion
