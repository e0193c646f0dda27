#include "ros/bags/bag_images.h"

namespace depth_fusion {

BagImage readImage(const rosbag::MessageInstance& place, const rosbag::Bag& bag) {
  BagImage image;
  image.name = bag.getFileName() + ": " + place.getTopic();
  image.received_s = place.getTime().toSec();
  std_msgs::Header header;
  if (place.getDataType() == kCompressedImageType) {
    image.compressed = readMessage<sensor_msgs::CompressedImage>(place, bag);
    header = image.compressed->header;
  } else {
    image.raw = readMessage<sensor_msgs::Image>(place, bag);
    header = image.raw->header;
  }
  image.stamp_s = header.stamp.isZero() ? image.received_s : header.stamp.toSec();
  image.frame_id = header.frame_id;
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
