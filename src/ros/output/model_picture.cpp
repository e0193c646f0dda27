#include "ros/output/model_picture.h"

#include <sensor_msgs/Image.h>

#include <boost/make_shared.hpp>

#include "ros/conversions/messages.h"

namespace depth_fusion {

void ModelPicture::publish(const std_msgs::Header& header, ModelViewRenderer& renderer,
                           const ModelPictureParameters& parameters, StageTimers& timers) {
  const ros::WallTime now = ros::WallTime::now();
  if (!hasViewers() || (now - last_).toSec() < 1.0 / parameters.picture_rate_hz) return;
  last_ = now;
  const StageTimers::Scope timer(timers, "model_view/picture");
  publisher_.publish(boost::make_shared<sensor_msgs::Image>(makeColorImage(
      header, parameters.picture == "colored" ? renderer.coloredPicture() : renderer.shadedPicture())));
}

}  // namespace depth_fusion
