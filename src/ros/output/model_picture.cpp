#include "ros/output/model_picture.h"

#include <image_transport/image_transport.h>
#include <sensor_msgs/Image.h>

#include <boost/make_shared.hpp>
#include <limits>

#include "depth_fusion/compute/device_image.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {

ModelPicture::ModelPicture(ros::NodeHandle& handle)
    : picture_publisher_(image_transport::ImageTransport(handle).advertise(kModelPictureTopic, 1)),
      depth_publisher_(handle.advertise<sensor_msgs::Image>("model_view/depth", 1)),
      info_publisher_(handle.advertise<sensor_msgs::CameraInfo>("model_view/camera_info", 1)) {}

bool ModelPicture::hasViewers() const {
  return picture_publisher_.getNumSubscribers() + depth_publisher_.getNumSubscribers() > 0;
}

void ModelPicture::publish(const std_msgs::Header& header, ModelViewRenderer& renderer,
                           const ModelPictureParameters& parameters, StageTimers& timers) {
  const ros::WallTime now = ros::WallTime::now();
  if (!hasViewers() || (now - last_).toSec() < 1.0 / parameters.picture_rate_hz) return;
  last_ = now;
  const StageTimers::Scope timer(timers, "model_view/picture");
  const ModelView& view = *renderer.view();
  info_publisher_.publish(makeCameraInfo(header, view.camera));
  if (picture_publisher_.getNumSubscribers() > 0)
    picture_publisher_.publish(boost::make_shared<sensor_msgs::Image>(makeColorImage(
        header, parameters.picture == "colored" ? renderer.coloredPicture() : renderer.shadedPicture())));
  if (depth_publisher_.getNumSubscribers() == 0) return;
  cv::Mat depth_m = readImage(view.depth, view.camera);
  depth_m.setTo(std::numeric_limits<float>::quiet_NaN(), depth_m == 0.0f);
  depth_publisher_.publish(boost::make_shared<sensor_msgs::Image>(makeDepthImage(header, depth_m, 1.0)));
}

}  // namespace depth_fusion
