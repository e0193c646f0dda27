// The map as the camera sees it: a picture for viewers, and depth without holes for other nodes.
#pragma once

#include <image_transport/publisher.h>
#include <ros/node_handle.h>

#include "depth_fusion/model_view/model_view_renderer.h"
#include "ros/output/model_picture_parameters.h"

namespace depth_fusion {

constexpr char kModelPictureTopic[] = "model_view/image";

class ModelPicture {
 public:
  // Advertises model_view/image, with every transport that has a plugin of image_transport here, and
  // model_view/depth and model_view/camera_info.
  explicit ModelPicture(ros::NodeHandle& handle);

  bool hasViewers() const;
  // Publishes the last view as a picture and as depth in metres (NaN: no surface) with the camera_info of
  // both, as far as somebody looks and the rate allows. `header` is that of the frame whose pose the view
  // has.
  void publish(const std_msgs::Header& header, ModelViewRenderer& renderer,
               const ModelPictureParameters& parameters, StageTimers& timers);

 private:
  image_transport::Publisher picture_publisher_;
  ros::Publisher depth_publisher_, info_publisher_;
  ros::WallTime last_;
};

}  // namespace depth_fusion
