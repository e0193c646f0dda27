// A map that nodelets find as that of tsdf_fusion, and that the test changes.
#pragma once

#include <memory>
#include <string>

#include "ros/in_process/shared_map.h"
#include "support/changing_map.h"

namespace depth_fusion {

inline SignedDistance ball(const Eigen::Vector3d& centre, double radius_m) {
  return [=](const Eigen::Vector3d& p) { return (p - centre).norm() - radius_m; };
}

class OfferedMap {
 public:
  explicit OfferedMap(const std::string& name, bool color = false)
      : map_(std::make_shared<SharedMap>(sharedCompute(""), parameters(color))),
        changing_(*map_->compute, map_->map) {
    map_->frame_id = "map";
    offerMap(name, map_);
  }

  SharedMap& shared() { return *map_; }

  void show(const SignedDistance& distance) {
    const std::lock_guard<std::mutex> lock(map_->mutex);
    changing_.show(distance, [this](const std::vector<int>& slots) { map_->noteUpdated(slots); });
  }
  void reset() {
    const std::lock_guard<std::mutex> lock(map_->mutex);
    map_->reset();
  }
  TriangleMesh mesh() {
    const std::lock_guard<std::mutex> lock(map_->mutex);
    TriangleMesh mesh;
    exportSurfaceMesh(*map_->compute, map_->map, mesh);
    return mesh;
  }
  bool isFollowed() {
    const std::lock_guard<std::mutex> lock(map_->mutex);
    return map_->isFollowed();
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
  ChangingMap changing_;
};

}  // namespace depth_fusion
