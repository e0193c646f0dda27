// The map as the camera sees it, as a picture for viewers.
#pragma once

#include <ros/publisher.h>

#include "depth_fusion/model_view/model_view_renderer.h"
#include "ros/output/model_picture_parameters.h"

namespace depth_fusion {

class ModelPicture {
 public:
  explicit ModelPicture(const ros::Publisher& publisher) : publisher_(publisher) {}

  bool hasViewers() const { return publisher_.getNumSubscribers() > 0; }
  // Publishes a picture of the last view, if somebody looks and the rate allows.
  void publish(const std_msgs::Header& header, ModelViewRenderer& renderer,
               const ModelPictureParameters& parameters, StageTimers& timers);

 private:
  ros::Publisher publisher_;
  ros::WallTime last_;
};

}  // namespace depth_fusion
