// The robot's own body, where the camera sees it.
#pragma once

#include <ros/node_handle.h>
#include <tf2_ros/transform_listener.h>

#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "depth_fusion/masking/masking_parameters.h"
#include "depth_fusion/masking/solid_body.h"
#include "ros/in_process/frames.h"

namespace depth_fusion {

// Thread-safe. Without a body it costs nothing: nothing is asked of tf then.
class RobotBody {
 public:
  RobotBody(const ros::NodeHandle& handle, const MaskingParameters& parameters);

  // Throws Error for a body that is none. The URDF stays.
  void setParameters(const MaskingParameters& parameters);
  // tf has every part at the image's stamp, or there is none.
  bool isKnown(const std_msgs::Header& image);
  // The frame without what the camera sees of the body; the frame itself if there is none. Throws Error that
  // says what is missing.
  SensorFramePtr withoutBody(const SensorFramePtr& frame);

 private:
  // What is cut out now; null for nothing. The URDF is looked for once a second until it is there.
  struct Body {
    std::vector<BodyPart> parts;
    std::set<std::string> frames;
    double padding_m;
  };
  std::shared_ptr<const Body> body();
  void readModel();
  void renew();

  ros::NodeHandle handle_;
  std::mutex mutex_;  // of the rest
  MaskingParameters parameters_;
  std::vector<BodyPart> model_;  // of the URDF
  std::string model_problem_;    // why there is none yet
  ros::WallTime model_tried_;
  std::shared_ptr<const Body> body_;
  std::unique_ptr<tf2_ros::Buffer> tf_;  // null, as is the next, before they are needed
  std::unique_ptr<tf2_ros::TransformListener> tf_listener_;
};

}  // namespace depth_fusion
