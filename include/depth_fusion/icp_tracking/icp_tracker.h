// ICP tracking: the pose of a depth frame against the model view (the paper's section "Registration").
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "depth_fusion/common/stage_timers.h"
#include "depth_fusion/compute/compute_context.h"
#include "depth_fusion/frames/depth_frame.h"
#include "depth_fusion/frames/model_view.h"
#include "depth_fusion/frames/motion_prior.h"
#include "depth_fusion/frames/tracking_result.h"
#include "depth_fusion/icp_tracking/icp_tracking_parameters.h"

namespace depth_fusion {

struct MatchGates;

class IcpTracker {
 public:
  class Kernels;  // typed launches, private to the library and its tests
  struct SystemPrior;
  struct Alignment;

  IcpTracker(ComputeContext& compute, const IcpTrackingParameters& parameters,
             const CameraIntrinsics& camera);
  ~IcpTracker();

  // The frames to come are aligned by these.
  void setParameters(const IcpTrackingParameters& parameters);

  // Aligns the frame to the view, coarse to fine, starting from the prior. A prior with a covariance takes
  // part in the solution and fills the directions that geometry leaves free; without one the pose stays where
  // it is along them (TrackingResult::guessed_directions).
  TrackingResult track(const DepthFrame& frame, const ModelView& view, const MotionPrior& prior,
                       StageTimers& timers);
  // Aligns the frame to the view from each of the starts (T_W_D, one at least) at the coarsest level, and
  // returns the pose by which the view explains most of the frame: a start for track().
  Pose bestStart(const DepthFrame& frame, const ModelView& view, const std::vector<Pose>& starts,
                 StageTimers& timers);

 private:
  MatchGates gatesAt(int level) const;
  // Iterates until it converges. False if hardly a point finds a match.
  bool alignLevel(int level, const DepthFrame& frame, const ModelView& view, const SystemPrior& prior,
                  const Eigen::AlignedBox3d& box, Alignment& alignment);

  IcpTrackingParameters parameters_;
  DeviceBuffer partial_sums_;
  std::unique_ptr<Kernels> kernels_;
};

}  // namespace depth_fusion
