#include "ros/bag_images.h"

namespace depth_fusion {

BagImage readImage(const rosbag::MessageInstance& place, const rosbag::Bag& bag) {
  BagImage image;
  image.name = bag.getFileName() + ": " + place.getTopic();
  image.received_s = place.getTime().toSec();
  ros::Time stamp;
  if (place.getDataType() == kCompressedImageType) {
    image.compressed = readMessage<sensor_msgs::CompressedImage>(place, bag);
    stamp = image.compressed->header.stamp;
  } else {
    image.raw = readMessage<sensor_msgs::Image>(place, bag);
    stamp = image.raw->header.stamp;
  }
  image.stamp_s = stamp.isZero() ? image.received_s : stamp.toSec();
  return image;
}

DepthImage toDepth(const BagImage& image) {
  if (!image.raw) return depthFromCompressed(*image.compressed, image.name);
  const DepthImage depth = depthFromImage(*image.raw, image.name);
  return {depth.image.clone(), depth.unit_m};
}

cv::Mat toColor(const BagImage& image) {
  return image.raw ? colorFromImage(*image.raw, image.name).clone()
                   : colorFromCompressed(*image.compressed, image.name);
}

}  // namespace depth_fusion
