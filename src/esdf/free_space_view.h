// What a depth image shows of space, for who looks for free cells.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "depth_fusion/frames/depth_frame.h"
#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/map/slot_table.h"
#include "esdf/types.h"

namespace depth_fusion {

class FreeSpaceView {
 public:
  FreeSpaceView(const DepthFrame& frame, const Pose& T_W_D);
  // Depth in metres, CV_32FC1 of the camera's size, 0 = none, without noise.
  FreeSpaceView(const cv::Mat& depth_m, const CameraIntrinsics& camera, const Pose& T_W_D);

  const CameraIntrinsics& camera() const { return camera_; }
  const Pose& T_D_W() const { return T_D_W_; }
  const SensorArgs& sensor() const { return sensor_; }
  // How many times it counts for a cell to be seen to be free, and how many it takes to be hidden.
  int sight() const { return sight_; }
  int doubt() const { return doubt_; }
  // The cubes of that size, counted from the origin of W, of which some part may lie before what is seen.
  std::vector<BlockIndex> blocks(double edge_m) const;

 private:
  bool isBefore(const Eigen::Vector3d& centre_D, double radius_m) const;
  // The farthest depth in the part of the image that a sphere covers; it lies in front of the camera.
  float farthest_m(const Eigen::Vector3d& centre_D, double radius_m) const;

  CameraIntrinsics camera_;
  Pose T_D_W_;
  SensorArgs sensor_;
  int sight_, doubt_;
  std::vector<float> tiles_m_;  // the farthest depth of each tile of DEPTH_TILE^2 pixels
  int tile_columns_, tile_rows_;
};

}  // namespace depth_fusion
