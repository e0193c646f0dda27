#include "ros/bags/bag_images.h"

namespace depth_fusion {

BagImage readImage(const rosbag::MessageInstance& place, const rosbag::Bag& bag) {
  BagImage image;
  image.name = bag.getFileName() + ": " + place.getTopic();
  image.received_s = place.getTime().toSec();
  if (place.getDataType() == kCompressedImageType) {
    image.message.compressed = readMessage<sensor_msgs::CompressedImage>(place, bag);
  } else {
    image.message.raw = readMessage<sensor_msgs::Image>(place, bag);
  }
  const ros::Time& stamp = image.message.header().stamp;
  image.stamp_s = stamp.isZero() ? image.received_s : stamp.toSec();
  return image;
}

DepthImage toDepth(const BagImage& image) {
  const DepthImage depth = toDepth(image.message, image.name);
  return {image.message.raw ? depth.image.clone() : depth.image, depth.unit_m};
}

cv::Mat toColor(const BagImage& image) {
  const cv::Mat color = toColor(image.message, image.name);
  return image.message.raw ? color.clone() : color;
}

}  // namespace depth_fusion
