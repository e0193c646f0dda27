// Tracked frames into a live map, and model views out of it.
#pragma once

#include <memory>
#include <string>

#include "depth_fusion/pipeline/motion_model.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"
#include "ros/in_process/frame_admission.h"
#include "ros/in_process/shared_map.h"

namespace depth_fusion {

// What became of a frame.
struct MappingOutcome {
  bool accepted = false;  // it is in the map, or may be predicted from for another reason
  bool fused = false;
  std::string reason;  // why not, or what was left out
  size_t blocks_left_out = 0;
};

// Whoever calls it does so in SharedMap::locked, always of the same map.
class FrameMapper {
 public:
  // `external`: the frames' poses come from elsewhere than icp_tracking. The map has not been reset yet.
  FrameMapper(SharedMap& map, const PipelineParameters& parameters, bool external)
      : compute_(map.compute),
        parameters_(parameters),
        admission_(external, map.locked([](FusedMap& fused) { return fused.map().generation(); })) {}

  // The parameters are for the frames to come.
  void setParameters(const PipelineParameters& parameters);
  // Fuses the frame if it is admitted.
  MappingOutcome map(const TrackedFrame& frame, FusedMap& map, bool resets_on_jump, StageTimers& timers);
  // Renders the view of an accepted frame.
  void render(const TrackedFrame& frame, FusedMap& map, StageTimers& timers);
  ModelViewRenderer& renderer(FusedMap& map) const { return map.mapper(camera_).renderer(); }
  // Takes in a stored map by a call: frames from before are refused from now on. Throws Error as FusedMap
  // does.
  void load(FusedMap& map, ReadMap& stored, const std::string& name, const MapReset& reset);
  // Takes in the map as it was made anew, by which its poses move. Throws Error as FusedMap does.
  void replace(FusedMap& map, ReadMap& refined, const std::string& name, const Corrections& corrections);
  // The last such move of the map that there is; null if it came otherwise.
  const std::shared_ptr<const MapMove>& move() const { return move_; }
  const PipelineParameters& parameters() const { return parameters_; }
  const CameraIntrinsics& camera() const { return camera_; }
  // The pose of the last fused frame.
  const StampedPose& lastPose() const { return last_pose_; }
  // What is stored of the map beside its contents.
  MapDescription describe(FusedMap& map) const;
  // Empties the map by a call: frames from before are refused from now on.
  void reset(FusedMap& map, const MapReset& reset);

  FrameAdmission& admission() { return admission_; }
  const FrameAdmission& admission() const { return admission_; }
  // The last accepted frame's, or null.
  const std::shared_ptr<const ModelView>& view() const { return view_; }

 private:
  void prepare(const CameraIntrinsics& camera);
  void empty(FusedMap& map);
  // Has view() be that of the last pose.
  void renderLast(FusedMap& map);
  MappingOutcome fuse(const TrackedFrame& frame, FusedMap& map, StageTimers& timers);

  std::shared_ptr<ComputeContext> compute_;
  PipelineParameters parameters_;
  FrameAdmission admission_;
  CameraIntrinsics camera_;
  MotionModel motion_;                               // of frames that come without preprocessed depth
  std::unique_ptr<DepthPreprocessor> preprocessor_;  // the same
  std::shared_ptr<const ModelView> view_;
  StampedPose last_pose_;
  std::shared_ptr<const MapMove> move_;
};

}  // namespace depth_fusion
