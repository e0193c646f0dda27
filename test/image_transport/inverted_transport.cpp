// A transport of images that inverts every byte on the way.
#include <image_transport/simple_publisher_plugin.h>
#include <image_transport/simple_subscriber_plugin.h>

#include <boost/make_shared.hpp>
#include <pluginlib/class_list_macros.hpp>

namespace depth_fusion {
namespace {

constexpr char kName[] = "inverted";

sensor_msgs::Image inverted(sensor_msgs::Image image) {
  for (uint8_t& byte : image.data) byte = static_cast<uint8_t>(~byte);
  return image;
}

}  // namespace

class InvertedPublisher : public image_transport::SimplePublisherPlugin<sensor_msgs::Image> {
 public:
  std::string getTransportName() const override { return kName; }

 protected:
  void publish(const sensor_msgs::Image& image, const PublishFn& publish) const override {
    publish(inverted(image));
  }
};

class InvertedSubscriber : public image_transport::SimpleSubscriberPlugin<sensor_msgs::Image> {
 public:
  std::string getTransportName() const override { return kName; }

 protected:
  void internalCallback(const sensor_msgs::ImageConstPtr& image, const Callback& take) override {
    take(boost::make_shared<sensor_msgs::Image>(inverted(*image)));
  }
};

}  // namespace depth_fusion

PLUGINLIB_EXPORT_CLASS(depth_fusion::InvertedPublisher, image_transport::PublisherPlugin)
PLUGINLIB_EXPORT_CLASS(depth_fusion::InvertedSubscriber, image_transport::SubscriberPlugin)
