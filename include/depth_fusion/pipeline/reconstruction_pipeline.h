// One frame's way through all the stages.
#pragma once

#include <memory>

#include "depth_fusion/pipeline/frame_ahead.h"
#include "depth_fusion/pipeline/loop_closing.h"
#include "depth_fusion/pipeline/mapper.h"
#include "depth_fusion/pipeline/tracking_session.h"
#include "depth_fusion/submaps/map_file.h"

namespace depth_fusion {

struct FrameResult {
  TrackingResult tracking;
  FusionResult fusion;  // all zero if the frame was not fused
  ColorFusionResult color;
};

// Tracks and fuses frame by frame. W is the first fused frame's camera frame, or that of the given poses.
// Where gravity is known, W's z is up, and where a ground robot's base is, it begins there.
class ReconstructionPipeline {
 public:
  ReconstructionPipeline(ComputeContext& compute, const PipelineParameters& parameters,
                         const CameraIntrinsics& camera);

  // Tracks the frame and fuses it; a lost frame changes nothing in the map, but many lost frames have a map
  // of a few frames begin anew (RelocalisationParameters::young_map_frames). `next` announces the frame of
  // the next call, if it is there already: its texture odometry then runs beside this frame's stages, and its
  // preprocessing beside this frame's fusion and model view, with the same results. Throws Error if another
  // frame was announced.
  FrameResult processFrame(const RgbdFrame& frame, const RgbdFrame* next = nullptr);

  // Fuses the frame at a pose from elsewhere; it is lost only if nothing of it can be fused. Throws Error if
  // a frame was announced.
  FrameResult processFrame(const RgbdFrame& frame, const Pose& T_W_D);

  // Has loops sought from the next tracked frame on. What they make of the poses is for the caller to use:
  // the map stays as it is.
  void closeLoops();
  // Null where loops are not sought.
  LoopClosing* loops() { return loops_.get(); }

  // Goes on with a stored map: W is the map's, and the sensor is searched for in it. Throws Error, and
  // changes nothing, if the map does not fit the parameters or is damaged, or if a frame was announced.
  LoadedMap load(Database& stored);
  // Saves the map as it is now. Throws Error if it cannot be written.
  SaveReport save(MapSaver& saver);

  // What is wrong with the robot's other sensors; empty if nothing is.
  std::string robotProblem() const { return robot_.problem(); }

  // The part of the map that is in the pool.
  BlockMap& map() { return map_; }
  SubmapCollection& submaps() { return submaps_; }
  StageTimers& timers() { return timers_; }
  const PipelineParameters& parameters() const { return parameters_; }
  // The last frame, preprocessed; null before the first.
  std::shared_ptr<const DepthFrame> depth() const { return session_.depth(); }
  size_t keyframeCount() const { return session_.keyframes().size(); }
  const Keyframes& keyframes() const { return session_.keyframes(); }
  // Takes these for the map's keyframes; the sensor is then searched for.
  void setKeyframes(Keyframes keyframes);

 private:
  void beginAnew();
  // The sensor has been lost for long: another part of the map begins, unless what there is cannot be stored.
  void beginPart();
  // Fuses the session's frame and renders the view that the next one is tracked against. A frame that an
  // exception leaves unfinished is given up, so that the next one can come.
  void fuseAndRender(const RgbdFrame& frame, FrameResult& result);
  // Fuses the session's frame, unless it is lost; it is lost if nothing could be fused.
  void fuse(const RgbdFrame& frame, FrameResult& result, bool is_given = false);

  PipelineParameters parameters_;
  CameraIntrinsics camera_;
  StageTimers timers_;
  BlockMap map_;
  SubmapCollection submaps_;
  TextureOdometry odometry_;
  RobotMotion robot_;
  Mapper mapper_;
  std::unique_ptr<ComputeContext> tracking_queue_;
  TrackingSession session_;
  const ModelView* view_ = nullptr;  // of the last fused frame; none before the first
  StampedPose last_pose_;            // of the last fused frame
  std::unique_ptr<LoopClosing> loops_;
  FrameAhead ahead_;
};

}  // namespace depth_fusion
