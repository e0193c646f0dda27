// The service clear_region: a part of the map is forgotten.
#pragma once

#include <depth_fusion/ClearRegion.h>

#include <memory>

#include "ros/in_process/shared_map.h"
#include "ros/output/map_transforms.h"

namespace depth_fusion {

// For one thread at a time.
class RegionClearing {
 public:
  explicit RegionClearing(std::shared_ptr<SharedMap> map) : map_(std::move(map)) {}

  // Throws Error for a region that is none, and if tf does not say where it is.
  ClearRegion::Response clear(const ClearRegion::Request& request);

 private:
  Pose poseInMap(const ClearRegion::Request& request);

  const std::shared_ptr<SharedMap> map_;
  MapTransforms transforms_;
};

}  // namespace depth_fusion
