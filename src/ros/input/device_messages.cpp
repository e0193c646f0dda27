#include "ros/input/device_messages.h"

#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

constexpr double kMillimetre_m = 0.001;

sensor_msgs::ImagePtr aroundPixels(DeviceImage image, const std_msgs::Header& header,
                                   std::shared_ptr<FrameBuffers> buffers) {
  const sensor_msgs::ImagePtr message(new sensor_msgs::Image,
                                      [buffers = std::move(buffers)](sensor_msgs::Image* done) {
                                        buffers->recycle(std::move(done->data));
                                        delete done;
                                      });
  message->header = header;
  message->width = static_cast<uint32_t>(image.width);
  message->height = static_cast<uint32_t>(image.height);
  message->encoding = image.encoding;
  message->step = static_cast<uint32_t>(image.step);
  message->data = std::move(image.pixels);
  return message;
}

// ROS has 16 bits for millimetres only; depth in other units goes out as metres in 32 bits.
sensor_msgs::ImagePtr inMetres(DeviceImage image, const std_msgs::Header& header) {
  const cv::Mat depth(image.height, image.width, CV_16UC1, image.pixels.data(), image.step);
  return boost::make_shared<sensor_msgs::Image>(makeDepthImage(header, depth, image.depth_unit_m));
}

}  // namespace

sensor_msgs::ImagePtr toMessage(DeviceImage image, const std_msgs::Header& header,
                                std::shared_ptr<FrameBuffers> buffers) {
  const bool fits_ros = image.stream != ImageStream::kDepth || image.depth_unit_m == kMillimetre_m;
  return fits_ros ? aroundPixels(std::move(image), header, std::move(buffers))
                  : inMetres(std::move(image), header);
}

}  // namespace depth_fusion
