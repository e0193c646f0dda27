// ICP tracking: the pose of a depth frame against the model view (the paper's section "Registration").
#pragma once

#include <memory>
#include <string>

#include "depth_fusion/common/parameters.h"
#include "depth_fusion/common/stage_timers.h"
#include "depth_fusion/geometry/motion_prior.h"
#include "depth_fusion/model_view/model_view.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"

namespace depth_fusion {

struct IcpTrackingParameters {
  int coarse_iterations = 6;
  int middle_iterations = 5;
  int fine_iterations = 5;
  int fine_row_step = 2;
  float coarse_distance_m = 0.1f;
  float fine_distance_m = 0.04f;
  float coarse_normal_angle_rad = 0.8f;
  float fine_normal_angle_rad = 0.6f;
  float huber_sigmas = 2.0f;
  float convergence_rad = 1e-4f;
  float convergence_m = 1e-4f;
  float degeneracy_threshold = 0.005f;
  float correlated_points = 300.0f;
  float min_inlier_fraction = 0.25f;
  int min_inliers = 2000;
  float max_rmse_m = 0.02f;
  float max_translation_m = 0.3f;
  float max_rotation_rad = 0.5f;

  ParameterTable table();
};

enum class TrackingStatus {
  kTracking,
  kDegenerate,  // geometry leaves directions free; the pose has them from the prior
  kLost
};

struct TrackingResult {
  TrackingStatus status = TrackingStatus::kLost;
  std::string reason;             // why tracking is lost, or which directions are free; else empty
  Pose T_W_D = Pose::Identity();  // valid unless lost
  Matrix6d covariance = Matrix6d::Identity();  // of the twist applied to T_W_D on the left
  int inliers = 0;
  double inlier_fraction = 0.0;  // of the frame's points with depth and normal
  double rmse_m = 0.0;  // of the inliers' point-to-plane distances, weighted by the sensor's accuracy
  double smallest_eigenvalue = 0.0;  // of the system in the unit cube, divided by the matches' weights
  int iterations = 0;
};

struct MatchGates;

class IcpTracker {
 public:
  class Kernels;  // typed launches, private to the library and its tests
  struct SystemPrior;
  struct Alignment;

  IcpTracker(ComputeContext& compute, const IcpTrackingParameters& parameters,
             const CameraIntrinsics& camera);
  ~IcpTracker();

  // For the frames to come.
  void setParameters(const IcpTrackingParameters& parameters);

  // Aligns the frame to the view, coarse to fine, starting from the prior. A prior with a covariance takes
  // part in the solution and fills the directions that geometry leaves free; without one, free directions
  // mean that it is lost.
  TrackingResult track(const DepthFrame& frame, const ModelView& view, const MotionPrior& prior,
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
