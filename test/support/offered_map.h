// A map that nodelets find as that of tsdf_fusion, and that the test changes.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "depth_fusion/surface_mesh/surface_mesh.h"
#include "ros/in_process/shared_map.h"
#include "support/changing_map.h"

namespace depth_fusion {

inline SignedDistance ball(const Eigen::Vector3d& centre, double radius_m) {
  return [=](const Eigen::Vector3d& p) { return (p - centre).norm() - radius_m; };
}

class OfferedMap {
 public:
  explicit OfferedMap(const std::string& name, bool color = false)
      : map_(std::make_shared<SharedMap>(sharedCompute(""), parameters(color), "map")) {
    offerMap(name, map_);
  }

  size_t blocks() {
    return map_->locked([](FusedMap& fused) { return fused.map().slots().used(); });
  }

  void show(const SignedDistance& distance) {
    map_->locked([&](FusedMap& fused) { ChangingMap(*map_->compute, fused.map()).show(distance); });
  }
  void reset() {
    map_->locked([](FusedMap& fused) { fused.reset(); });
  }
  TriangleMesh mesh() {
    return map_->locked([&](FusedMap& fused) {
      TriangleMesh mesh;
      exportSurfaceMesh(*map_->compute, fused.map(), mesh);
      return mesh;
    });
  }
  void seeFrom(const Eigen::Vector3d& camera_W) {
    map_->locked([&](FusedMap& fused) { fused.noteFrame(0.0, camera_W); });
  }
  // Runs the action while nobody else gets at the map.
  void whileHeld(const std::function<void()>& action) {
    map_->locked([&](FusedMap&) { action(); });
  }
  bool isFollowed() {
    return map_->locked([](FusedMap& fused) { return fused.map().isFollowed(); });
  }

 private:
  static PipelineParameters parameters(bool color) {
    PipelineParameters parameters;
    parameters.map.voxel_size_m = 0.005f;
    parameters.map.blocks_per_axis = 32;
    parameters.map.pool_mib = 16;
    parameters.map.color = color;
    return parameters;
  }

  std::shared_ptr<SharedMap> map_;
};

}  // namespace depth_fusion
