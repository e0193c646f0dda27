// ICP tracking: the pose of a depth frame against the model view (the paper's section "Registration").
#pragma once

#include <memory>
#include <string>

#include "depth_fusion/common/parameters.h"
#include "depth_fusion/common/stage_timers.h"
#include "depth_fusion/model_view/model_view.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"

namespace depth_fusion {

struct IcpTrackingParameters {
  int coarse_iterations = 6;
  int middle_iterations = 5;
  int fine_iterations = 5;
  float coarse_distance_m = 0.1f;
  float fine_distance_m = 0.04f;
  float max_normal_angle_rad = 0.6f;
  float convergence_rad = 5e-5f;
  float convergence_m = 5e-5f;
  float min_inlier_fraction = 0.25f;
  int min_inliers = 2000;
  float max_rmse_m = 0.02f;
  float max_translation_m = 0.3f;
  float max_rotation_rad = 0.5f;

  ParameterTable table();
};

enum class TrackingStatus { kTracking, kLost };

struct TrackingResult {
  TrackingStatus status = TrackingStatus::kLost;
  std::string reason;             // why tracking is lost; empty otherwise
  Pose T_W_D = Pose::Identity();  // valid unless lost
  int inliers = 0;
  double inlier_fraction = 0.0;   // of the frame's points with depth and normal
  double rmse_m = 0.0;            // of the inliers' point-to-plane distances, weighted by the sensor's accuracy
  int iterations = 0;
};

class IcpTracker {
 public:
  class Kernels;  // typed launches, private to the library and its tests

  IcpTracker(ComputeContext& compute, const IcpTrackingParameters& parameters, const CameraIntrinsics& camera);
  ~IcpTracker();

  // Aligns the frame to the view, coarse to fine, starting from T_W_D_prior.
  TrackingResult track(const DepthFrame& frame, const ModelView& view, const Pose& T_W_D_prior, StageTimers& timers);

 private:
  IcpTrackingParameters parameters_;
  DeviceBuffer partial_sums_;
  std::unique_ptr<Kernels> kernels_;
};

}  // namespace depth_fusion
