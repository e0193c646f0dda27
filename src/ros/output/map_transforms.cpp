#include "ros/output/map_transforms.h"

#include "depth_fusion/common/error.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

constexpr double kWaitForTf_s = 2.0;

}  // namespace

Pose MapTransforms::poseOf(const std::string& frame, const std::string& map_frame, const ros::Time& stamp) {
  if (frame.empty() || frame == map_frame) return Pose::Identity();
  if (tf_ == nullptr) {
    tf_ = std::make_unique<tf2_ros::Buffer>();
    listener_ = std::make_unique<tf2_ros::TransformListener>(*tf_);
  }
  try {
    return fromMessage(
        tf_->lookupTransform(map_frame, withoutSlash(frame), stamp, ros::Duration(kWaitForTf_s)).transform);
  } catch (const tf2::TransformException& error) {
    throw Error("tf does not say where " + frame + " is in " + map_frame + ": " + error.what());
  }
}

}  // namespace depth_fusion
