#include "ros/output/region_clearing.h"

#include <cmath>

#include "depth_fusion/common/error.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {

ClearRegion::Response RegionClearing::clear(const ClearRegion::Request& request) {
  const Eigen::Vector3d size(request.size.x, request.size.y, request.size.z);
  const bool is_sphere = size.isZero();
  check(size.allFinite() && (is_sphere || size.minCoeff() > 0.0),
        "size is that of a box in metres, above 0 in x, y and z, or all 0 for a sphere of radius");
  check(!is_sphere || (std::isfinite(request.radius) && request.radius > 0.0),
        "give the size of a box, or the radius of a sphere, in metres");
  const Pose T_W_R = poseInMap(request);
  const Pose T_R_W = T_W_R.inverse();
  const Eigen::Vector3d half =
      is_sphere ? Eigen::Vector3d::Constant(request.radius) : Eigen::Vector3d(0.5 * size);
  const Eigen::Vector3d reach = T_W_R.linear().cwiseAbs() * half;
  const Eigen::AlignedBox3d box_W(T_W_R.translation() - reach, T_W_R.translation() + reach);
  const double radius_m = request.radius;
  const auto isInside = [=](const Eigen::Vector3d& p_W) {
    const Eigen::Vector3d p_R = T_R_W * p_W;
    return is_sphere ? p_R.norm() <= radius_m : (p_R.cwiseAbs().array() <= half.array()).all();
  };
  ClearRegion::Response response;
  response.blocks = map_->locked([&](FusedMap& map) { return map.clear({box_W, isInside}); });
  response.success = true;
  response.message = "cleared in " + std::to_string(response.blocks) + " blocks";
  return response;
}

Pose RegionClearing::poseInMap(const ClearRegion::Request& request) {
  return transforms_.poseOf(request.header.frame_id, map_->frame_id, request.header.stamp) *
         fromMessage(request.pose);
}

}  // namespace depth_fusion
