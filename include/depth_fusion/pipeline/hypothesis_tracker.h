// A frame's pose from several hypotheses of where the sensor is: a prior is one of them, and is checked.
#pragma once

#include <vector>

#include "depth_fusion/frames/known_attitude.h"
#include "depth_fusion/icp_tracking/icp_tracker.h"

namespace depth_fusion {

// A pose that is searched for is measured in all directions, or the frame is lost.
TrackingResult lostIfGuessed(TrackingResult result);

class HypothesisTracker {
 public:
  HypothesisTracker(ComputeContext& compute, const IcpTrackingParameters& parameters,
                    const CameraIntrinsics& camera)
      : tracker_(compute, parameters, camera) {}

  void setParameters(const IcpTrackingParameters& parameters) { tracker_.setParameters(parameters); }

  // What is known of the pose of the frames to come, whatever they are tracked from.
  void setAttitude(const KnownAttitude& attitude) { attitude_ = attitude; }

  // Tracks the frame from the prior. Where the view then explains less of the frame than of those before, or
  // where depth contradicts the prior, it tracks from the other starts, too, and at last from all around
  // them; the pose by which the view explains most of the frame wins. The frame is lost if its matches fit
  // worse than usual even there.
  TrackingResult track(const DepthFrame& frame, const ModelView& view, const MotionPrior& prior,
                       const std::vector<MotionPrior>& others, StageTimers& timers);
  // Tracks a sensor that is lost from all around the start.
  TrackingResult search(const DepthFrame& frame, const ModelView& view, const MotionPrior& start,
                        StageTimers& timers);
  // Where depth alone puts a frame of a known pose by another view: from that pose, and if little of the
  // frame is explained there, from all around it.
  TrackingResult compare(const DepthFrame& frame, const ModelView& view, const Pose& T_W_D,
                         StageTimers& timers);
  // A sensor that was lost is found where about as much of the frame is explained as usual, and where the
  // matches tell in all directions which of alike places it is.
  TrackingResult orStillLost(TrackingResult result) const;

  // The frame is fused: it says what is usual.
  void accept(const TrackingResult& result);
  // Forgets what is usual.
  void reset() { usual_ = {}; }

 private:
  // Running means over the frames accepted.
  struct Usual {
    int frames = 0;
    double explained = 0.0, match_quality = 0.0;
  };

  // Tracks the frame from the prior and what is known of its attitude.
  TrackingResult align(const DepthFrame& frame, const ModelView& view, MotionPrior prior,
                       StageTimers& timers);
  // How much of a frame is to be explained: a share of what is usual, or, by a map of few frames, so much.
  double explainedBy(double few_frames, double of_usual) const;
  // Nothing speaks for looking elsewhere.
  bool isConvincing(const TrackingResult& result) const;
  // The map is of few frames, which may explain little of what is far, but depth agrees with a measured
  // prior.
  bool isConfirmed(const TrackingResult& result, const MotionPrior& prior) const;
  // The matches fit as well as usual.
  bool fitsAsUsual(const TrackingResult& result) const;
  TrackingResult orLost(TrackingResult result) const;
  // The result, which is lost for its pose may be a wrong one, if it is not lost already.
  TrackingResult lost(TrackingResult result) const;

  IcpTracker tracker_;
  KnownAttitude attitude_;
  Usual usual_;
};

}  // namespace depth_fusion
