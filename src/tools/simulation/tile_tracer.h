// What the rays of a part of an image meet.
#pragma once

#include <opencv2/core/types.hpp>
#include <vector>

#include "depth_fusion/geometry/camera_intrinsics.h"
#include "tools/simulation/scene.h"

namespace depth_fusion {

// Mirrors and glass are no hits: a ray goes on from them.
struct Hit {
  const Primitive* primitive = nullptr;  // null: nothing is hit
  double range_m = 0.0;                  // along the whole way
  Eigen::Vector3d p_W, ray_W;            // where and in which direction it arrives
  bool has_depth = true;                 // false: glass hides it
};

// Knows which solids the rays of a tile can meet, from near to far.
class TileTracer {
 public:
  TileTracer(const Scene& scene, const CameraIntrinsics& camera, const Pose& T_W_D, const cv::Rect& tile);

  // `ray_W` is a unit vector within the tile.
  Hit trace(const Eigen::Vector3d& ray_W) const;

 private:
  struct Candidate {
    const Primitive* primitive;
    double near_m;  // no ray meets it before
  };

  Hit firstHit(const Eigen::Vector3d& ray_W) const;

  const Scene& scene_;
  Eigen::Vector3d eye_W_;
  std::vector<Candidate> candidates_;
};

}  // namespace depth_fusion
