// The one conductor of tracking, offline and live: prediction, preprocessing, ICP tracking, relocalisation,
// keyframes.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "depth_fusion/frames/textured_frame.h"
#include "depth_fusion/pipeline/guessed_motion.h"
#include "depth_fusion/pipeline/hypothesis_tracker.h"
#include "depth_fusion/pipeline/map_drift.h"
#include "depth_fusion/pipeline/map_watch.h"
#include "depth_fusion/pipeline/motion_model.h"
#include "depth_fusion/pipeline/older_view.h"
#include "depth_fusion/pipeline/pipeline_parameters.h"
#include "depth_fusion/pipeline/young_map.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"
#include "depth_fusion/relocalisation/relocaliser.h"
#include "depth_fusion/texture_odometry/texture_odometry.h"

namespace depth_fusion {

// A frame with a pose from step() is fused, and conclude() says what became of it before the next step().
class TrackingSession {
 public:
  // The map as seen from T_W_D; valid until the next call.
  using RenderView = std::function<const ModelView&(const Pose& T_W_D)>;

  TrackingSession(ComputeContext& compute, const PipelineParameters& parameters,
                  const CameraIntrinsics& camera, RenderView render);

  // The parameters hold for the frames to come. Throws Error if they do not fit together.
  void setParameters(const PipelineParameters& parameters);

  // Finds the frame's pose by its depth against `view`, the model view of the last fused frame. `texture` is
  // the frame's own. A null view means that the map is empty: the frame then begins it at `start`. If the
  // frame does not fit the view, keyframes and the last pose say where else the sensor may be. Throws Error
  // if the frame does not fit the camera, or if the frame before is not concluded.
  TrackingResult step(const RgbdFrame& frame, TexturedFrame texture, const ModelView* view,
                      StageTimers& timers, const Pose& start = Pose::Identity());
  // Does the part of the next step() that needs neither view nor map, beside whatever else is done with this
  // step's pose; that pose is taken for good until conclude() says otherwise.
  void prepareAhead(const RgbdFrame& frame, const TexturedFrame& texture, StageTimers& timers);
  // Says whether the frame of the last step is fused. If it is, it may become a keyframe, with its colour
  // image if that frame is given. If it is not, all is as if its pose had never been found, and the next
  // frame is searched for.
  void conclude(bool fused, const RgbdFrame* pictured = nullptr);

  // Preprocesses a frame whose pose is known from elsewhere; the next one is predicted from there.
  void follow(const RgbdFrame& frame, const Pose& T_W_D, StageTimers& timers);
  // Passes over a frame that there was no time to track: what was measured of its motion counts.
  void skip(double stamp_s, const std::vector<FrameMotion>& measured);
  // Gives up the frame before: the next frame is searched for.
  void lose() { conclude(false); }
  // Forgets everything; the sensor is then searched for at T_W_D, and where the map's keyframes say.
  void reset(const Pose& T_W_D = Pose::Identity(), Keyframes keyframes = {});
  // Somebody says where the sensor is, to half a metre or so: it is searched for there first.
  void searchAt(const Pose& T_W_D);

  // The map is of few frames, and nothing fits it: whoever owns it had better empty it.
  bool givesUpMap() const { return young_map_.isGivenUp(parameters_.relocalisation); }
  // The map is emptied; the next step() without a view begins it anew where the sensor is expected.
  void beginAnew();

  // The sensor has been lost for so long, before something that a loop may know it again by, that whoever
  // owns the map had better begin another part of it.
  bool isLostForLong() const;
  // Nothing of the map is seen any more; the next step() without a view begins another part of it where the
  // sensor is expected. The keyframes stay.
  void beginPart();
  // Nothing says how what was mapped since then lies to the rest of the map: map_doubt says so from now on.
  void standsApart(double since_s);

  // TrackingResult::map_doubt, also of frames whose pose is known from elsewhere.
  const std::string& mapDoubt() const { return watch_.doubt().empty() ? apart_ : watch_.doubt(); }

  // The frame of the last step() or follow(), preprocessed.
  std::shared_ptr<const DepthFrame> depth() const { return depth_; }
  // Those of the frame with a pose from the last step(), until it is concluded.
  const FrameFeatures& features() const;
  const Keyframes& keyframes() const { return relocaliser_.keyframes(); }

 private:
  // The origins of the pose of a frame that begins a map, or a part of one.
  static constexpr char kStart[] = "start", kPartStart[] = "part start";

  // A frame that is ready to be tracked.
  struct PreparedFrame {
    double stamp_s;
    MotionPrior prior;
    std::shared_ptr<const DepthFrame> depth;
    bool knows_motion;  // something said how fast the sensor was while it was taken
  };
  // Takes what is known of the attitude, as far as the map is level.
  void takeAttitude(const KnownAttitude& attitude);
  // The frame was found: it says whether the map is level, and where a ground robot's floor is.
  void learnLevel(const KnownAttitude& attitude, const Pose& T_W_D);
  // Says of a lost frame where the sensor is meanwhile, and of another how far the priors are.
  void comparePriors(TrackingResult& result) const;
  // A frame with a pose that is not concluded.
  struct FoundFrame {
    double stamp_s;
    FrameFeatures features;
    TrackingResult result;
    MotionModel unless_fused;
    Matrix6d carried;  // by the pose, from priors
  };

  // A time without a pose.
  struct Loss {
    double since_s, until_s;
    bool sees_enough;  // in the last frame
  };

  MotionPrior takePrepared(const RgbdFrame& frame);
  // The frame is lost.
  void noteLoss(const RgbdFrame& frame, const FrameFeatures& features);
  // Another map, or part of one, is tracked against.
  void forgetMap();
  // A tracked frame at T_W_D, if its depth suffices for the next one to be tracked against.
  TrackingResult begin(const RgbdFrame& frame, const Pose& T_W_D) const;
  // Tracks the frame against the view, or lost against what else the map shows.
  TrackingResult track(const RgbdFrame& frame, const MotionPrior& prior, const FrameFeatures& features,
                       const ModelView& view, StageTimers& timers);
  // Tracks a frame whose prior misled also the compensation of its motion: its depth is preprocessed once
  // more, by the motion of before.
  TrackingResult trackUnbent(const RgbdFrame& frame, const MotionPrior& prior, const TrackingResult& bent,
                             const ModelView& view, StageTimers& timers);
  // Another frame is fused. The second one tells how fast the sensor was in the first: a map that began with
  // a bent frame is given up.
  void growMap();
  int pointsInRange(const RgbdFrame& frame) const;
  // Takes the frame's pose, unless it is guessed and may be far off by now: then the frame is lost.
  void take(double stamp_s, FrameFeatures features, TrackingResult& result);
  // Tracks against the map as it is seen from where a keyframe, or after a loss the prior, says that the
  // sensor is. Returns `lost` if nothing fits.
  TrackingResult relocalise(const MotionPrior& prior, const FrameFeatures& features,
                            const TrackingResult& lost, StageTimers& timers);
  // Searches for the sensor in these places, another few of them in each frame.
  TrackingResult searchFarther(const std::vector<Pose>& poses, StageTimers& timers);
  // Searches for the sensor about the pose that was given, for some frames.
  TrackingResult searchAtGiven(StageTimers& timers);
  TrackingResult searchAbout(const MotionPrior& start, StageTimers& timers);
  TrackingResult trackFrom(const MotionPrior& prior, StageTimers& timers);
  // Watches whether an older view of the map puts the frame elsewhere than at T_W_D, some frames in a while;
  // `view` becomes the older one where the frame sees too little of that. Null: the map is rendered from
  // T_W_D.
  void compareWithOlder(double stamp_s, const Pose& T_W_D, const ModelView* view, StageTimers& timers);
  // The result, or that the frame is lost if too little of it fits the map.
  TrackingResult orStillLost(TrackingResult result) const;

  PipelineParameters parameters_;
  RenderView render_;
  DepthPreprocessor preprocessor_;
  HypothesisTracker tracker_;
  MapDrift drift_;
  Matrix6d carried_ = Matrix6d::Zero();  // what priors leave in the last pose that is not in the drift
  Relocaliser relocaliser_;
  TextureOdometry matcher_;  // of frames to keyframes
  MotionModel motion_;
  std::optional<bool> is_level_;     // the map's z is along gravity; unknown until a frame is found in it
  std::optional<double> floor_z_m_;  // of a ground robot's base
  GuessedMotion guessed_;
  YoungMap young_map_;
  MapWatch watch_;
  OlderView older_;
  std::optional<double> begun_blindly_s_;  // when the map began, if nothing said then how fast the sensor was
  std::string begins_anew_for_;  // why the next map, or part of one, is one that begins anew; else empty
  bool begins_part_ = false;
  std::string apart_;  // that the part of the map is not joined to the rest; else empty
  std::optional<Loss> loss_;
  std::shared_ptr<const DepthFrame> depth_;
  std::optional<FoundFrame> found_;
  size_t next_search_ = 0;  // of the places farther away
  std::optional<PreparedFrame> ahead_;
  // Where somebody says that the sensor is, until it is found.
  struct GivenPose {
    Pose T_W_D;
    int frames_left;  // that it is searched for in
  };
  std::optional<GivenPose> given_;
};

}  // namespace depth_fusion
