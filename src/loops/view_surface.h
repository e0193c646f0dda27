// What a keyframe's camera sees, as points with normals, for loops to be verified on the host.
#pragma once

#include <optional>
#include <vector>

#include "depth_fusion/frames/depth_sensor.h"
#include "depth_fusion/geometry/camera_intrinsics.h"
#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/relocalisation/keyframe_view.h"

namespace depth_fusion {

struct SurfacePoint {
  Eigen::Vector3d point, normal;  // in frame D; the normal faces the camera
  double sigma_m = 0.0;           // of the depth
};

class ViewSurface {
 public:
  // The view is halved until it is 160 pixels wide at most.
  ViewSurface(const KeyframeView& view, const DepthSensorParameters& sensor);

  // Those with a normal.
  const std::vector<SurfacePoint>& points() const { return points_; }
  // What the camera sees in the direction of the point; none outside of its image and where it sees nothing.
  const SurfacePoint* seenTowards(const Eigen::Vector3d& p_D) const;
  // The nearest depth about the direction of the point; 0: none is known.
  double nearestDepth_m(const Eigen::Vector3d& p_D) const;

 private:
  std::optional<std::pair<int, int>> pixelOf(const Eigen::Vector3d& p_D) const;
  void addPoint(int u, int v, const DepthSensorParameters& sensor);
  Eigen::Vector3d pointAt(int u, int v) const;

  CameraIntrinsics camera_;
  cv::Mat depth_m_;
  std::vector<SurfacePoint> points_;
  std::vector<int> point_of_;  // of each pixel; -1: none
};

// How two views of the same surface lie to each other.
struct ViewAlignment {
  Pose T_old_new = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  // of the twist on the left
  double overlap = 0.0;                    // part of the smaller of the views' common that fits
  double rmse_m = 0.0, rmse_sigmas = 0.0;
  bool is_found = false;
};

// Point-to-plane ICP of the new view against the old one, from the pose that the features say, which takes
// part with its covariance.
ViewAlignment alignViews(const ViewSurface& old_view, const ViewSurface& new_view, const Pose& T_old_new,
                         const Matrix6d& covariance);

// The part of the one's surface that the other camera sees through, and the reverse; the larger of them. What
// lies behind the other's surface is hidden, and no contradiction.
double contradictedShare(const ViewSurface& old_view, const ViewSurface& new_view, const Pose& T_old_new);

}  // namespace depth_fusion
