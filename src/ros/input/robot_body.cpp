#include "ros/input/robot_body.h"

#include <algorithm>
#include <map>

#include "depth_fusion/common/error.h"
#include "ros/conversions/messages.h"
#include "ros/input/robot_model.h"

namespace depth_fusion {
namespace {

constexpr double kModelPeriod_s = 1.0;

}  // namespace

RobotBody::RobotBody(const ros::NodeHandle& handle, const MaskingParameters& parameters)
    : handle_(handle), parameters_(parameters) {
  renew();
}

void RobotBody::setParameters(const MaskingParameters& parameters) {
  const std::lock_guard<std::mutex> lock(mutex_);
  parameters_ = parameters;
  renew();
}

void RobotBody::renew() {
  auto body = std::make_shared<Body>();
  body->parts = parseBody(parameters_.body);
  body->parts.insert(body->parts.end(), model_.begin(), model_.end());
  for (const BodyPart& part : body->parts) body->frames.insert(withoutSlash(part.frame));
  body->padding_m = parameters_.padding_m;
  body_ = body->parts.empty() && parameters_.robot_description.empty() ? nullptr : body;
  if (body_ == nullptr || tf_ != nullptr) return;
  tf_ = std::make_unique<tf2_ros::Buffer>();
  tf_listener_ = std::make_unique<tf2_ros::TransformListener>(*tf_, handle_);
}

void RobotBody::readModel() {
  const ros::WallTime now = ros::WallTime::now();
  if ((now - model_tried_).toSec() < kModelPeriod_s) return;
  model_tried_ = now;
  const std::string name = handle_.resolveName(parameters_.robot_description);
  try {
    std::string urdf;
    check(handle_.getParam(parameters_.robot_description, urdf),
          "nothing is there; load a URDF, or leave masking/robot_description empty");
    model_ = partsOfRobot(urdf);
    model_problem_.clear();
    renew();
  } catch (const std::exception& error) {
    model_problem_ = "the robot's URDF, parameter " + name + ": " + error.what();
  }
}

std::shared_ptr<const RobotBody::Body> RobotBody::body() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (body_ != nullptr && !parameters_.robot_description.empty() && model_.empty()) readModel();
  return body_;
}

bool RobotBody::isKnown(const std_msgs::Header& image) {
  const std::shared_ptr<const Body> now = body();
  return now == nullptr || std::all_of(now->frames.begin(), now->frames.end(), [&](const std::string& frame) {
           return tf_->canTransform(image.frame_id, frame, image.stamp);
         });
}

SensorFramePtr RobotBody::withoutBody(const SensorFramePtr& frame) {
  const std::shared_ptr<const Body> now = body();
  if (now == nullptr) return frame;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    check(model_problem_.empty(), model_problem_);
  }
  check(!frame->rgbd.y_mirrored, "masking: the images' y points up, so that tf does not say what they show");
  std::map<std::string, Pose> T_D_F;
  for (const std::string& name : now->frames) {
    try {
      T_D_F[name] =
          fromMessage(tf_->lookupTransform(frame->header.frame_id, name, frame->header.stamp).transform);
    } catch (const tf2::TransformException& error) {
      throw Error("masking: where the robot's " + name +
                  " is at the image's stamp is not on tf: " + error.what());
    }
  }
  std::vector<PlacedSolid> solids;
  for (const BodyPart& part : now->parts)
    solids.push_back({T_D_F.at(withoutSlash(part.frame)) * part.T_F_S, part.solid});
  auto result = std::make_shared<SensorFrame>(*frame);
  cutOut(result->rgbd, solids, now->padding_m);
  return result;
}

}  // namespace depth_fusion
