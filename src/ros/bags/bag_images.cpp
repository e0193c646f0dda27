#include "ros/bags/bag_images.h"

#include <algorithm>
#include <functional>

#include "common/usual_size.h"
#include "depth_fusion/common/percentile.h"

namespace depth_fusion {
namespace {

constexpr int kMostLookedAt = 100;
constexpr size_t kSamples = 9;

ImageSample sample(const BagFiles& bags, const std::string& topic,
                   const std::function<cv::Size(const BagImage&)>& sizeOf) {
  rosbag::View view;
  bags.addTo(view, {topic});
  check(view.size() > 0, bags.name() + ": " + topic + " holds no message");
  std::string first_problem;
  std::vector<cv::Size> sizes;
  std::vector<std::string> frames;
  std::vector<double> leads_s;
  int looked_at = 0;
  for (auto place = view.begin(); place != view.end() && looked_at < kMostLookedAt && sizes.size() < kSamples;
       ++place, ++looked_at) {
    try {
      const BagImage image = readImage(*place, bags);
      sizes.push_back(sizeOf(image));
      frames.push_back(image.message.header().frame_id);
      leads_s.push_back(image.stamp_s - image.received_s);
    } catch (const Error& error) {
      if (first_problem.empty()) first_problem = error.what();
    }
  }
  check(!sizes.empty(), first_problem);
  const cv::Size size = usualSize(sizes);
  const auto usual = std::find(sizes.begin(), sizes.end(), size) - sizes.begin();
  return {size, frames[static_cast<size_t>(usual)], percentile(leads_s, 0.5), false};
}

}  // namespace

BagImage readImage(const rosbag::MessageInstance& place, const BagFiles& bags) {
  BagImage image;
  image.name = bags.name() + ": " + place.getTopic();
  image.received_s = place.getTime().toSec();
  if (place.getDataType() == kCompressedImageType) {
    image.message.compressed = readMessage<sensor_msgs::CompressedImage>(place, bags);
  } else if (place.getDataType() == kPointCloudType) {
    image.message.cloud = readMessage<sensor_msgs::PointCloud2>(place, bags);
  } else {
    image.message.raw = readMessage<sensor_msgs::Image>(place, bags);
  }
  const ros::Time& stamp = image.message.header().stamp;
  image.stamp_s = stamp.isZero() ? image.received_s : stamp.toSec();
  return image;
}

DepthImage toDepth(const BagImage& image) {
  const DepthImage depth = toDepth(image.message, image.name);
  return {image.message.raw ? depth.image.clone() : depth.image, depth.unit_m, depth.is_in_unusual_unit};
}

cv::Mat toColor(const BagImage& image) {
  const cv::Mat color = toColor(image.message, image.name);
  return image.message.raw ? color.clone() : color;
}

ImageSample sampleDepth(const BagFiles& bags, const std::string& topic) {
  bool is_in_unusual_unit = false;
  ImageSample depth = sample(bags, topic, [&](const BagImage& image) {
    const DepthImage decoded = toDepth(image);
    is_in_unusual_unit = decoded.is_in_unusual_unit;
    return decoded.image.size();
  });
  depth.is_in_unusual_unit = is_in_unusual_unit;
  return depth;
}

ImageSample sampleColor(const BagFiles& bags, const std::string& topic) {
  return sample(bags, topic, [](const BagImage& image) { return toColor(image).size(); });
}

}  // namespace depth_fusion
