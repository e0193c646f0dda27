#include "ros/bag_sources.h"

#include <sensor_msgs/CameraInfo.h>

#include <algorithm>

#include "ros/bag_images.h"

namespace depth_fusion {
namespace {

class SourceFinder {
 public:
  SourceFinder(const rosbag::Bag& bag, const RecordingOptions& options)
      : bag_(bag), options_(options), path_(bag.getFileName()), topics_(topicsOf(bag)) {}

  BagSources find() {
    BagSources sources;
    sources.depth_topic = depthTopic();
    const cv::Size depth_size = toDepth(firstImage(sources.depth_topic)).image.size();
    std::optional<RecordingIntrinsics> own;
    if (!options_.intrinsics) own = infoIntrinsics(sources.depth_topic, depth_size);
    sources.intrinsics = chooseIntrinsics(options_.intrinsics, own, depth_size, path_);
    sources.color_topic = colorTopic(sources.depth_topic);
    sources.remark = remark_;
    return sources;
  }

 private:
  std::string depthTopic() const {
    if (!options_.depth_topic.empty()) return givenTopic(options_.depth_topic);
    const auto topic = findDepthTopic(topics_);
    check(topic.has_value(), path_ + ": no depth topic found; the bag holds " + listTopics(topics_) +
                                 "; name one with --depth-topic");
    return topic->name;
  }

  std::string givenTopic(const std::string& name) const {
    const auto topic =
        std::find_if(topics_.begin(), topics_.end(), [&](const BagTopic& t) { return t.name == name; });
    check(topic != topics_.end(),
          path_ + ": there is no topic " + name + "; the bag holds " + listTopics(topics_));
    check(topic->type == kImageType || topic->type == kCompressedImageType,
          path_ + ": " + name + " is no image topic; the bag holds " + listTopics(topics_));
    return name;
  }

  // A topic that was found, not given, is left out if its colour cannot be read.
  std::string colorTopic(const std::string& depth_topic) {
    if (!options_.color_topic.empty()) {
      toColor(firstImage(givenTopic(options_.color_topic)));
      return options_.color_topic;
    }
    const auto topic = findColorTopic(topics_, depth_topic);
    if (!topic) return "";
    try {
      toColor(firstImage(topic->name));
      return topic->name;
    } catch (const Error& error) {
      remark_ += std::string("; colour is left out: ") + error.what();
      return "";
    }
  }

  BagImage firstImage(const std::string& topic) const {
    rosbag::View view(bag_, rosbag::TopicQuery(topic));
    check(view.size() > 0, path_ + ": " + topic + " holds no message");
    return readImage(*view.begin(), bag_);
  }

  std::optional<sensor_msgs::CameraInfo> firstInfo(const std::string& topic) const {
    rosbag::View view(bag_, rosbag::TopicQuery(topic));
    if (view.size() == 0) return std::nullopt;
    return *readMessage<sensor_msgs::CameraInfo>(*view.begin(), bag_);
  }

  RecordingIntrinsics infoIntrinsics(const std::string& depth_topic, cv::Size depth_size) {
    const std::string own_topic = ownInfoTopic(topics_, depth_topic);
    if (!own_topic.empty()) {
      if (const auto info = firstInfo(own_topic)) return fromInfo(*info, own_topic, depth_topic);
    }
    for (const std::string& topic : relatedInfoTopics(topics_, depth_topic)) {
      const auto info = firstInfo(topic);
      const bool fits = info && static_cast<int>(info->width) == depth_size.width &&
                        static_cast<int>(info->height) == depth_size.height;
      if (fits) return fromInfo(*info, topic, depth_topic);
    }
    throw Error(path_ + ": no camera_info found for " + depth_topic + "; the bag holds " +
                listTopics(topics_) + "; give the intrinsics with --intrinsics");
  }

  RecordingIntrinsics fromInfo(const sensor_msgs::CameraInfo& info, const std::string& topic,
                               const std::string& depth_topic) {
    if (ignoresDistortion(info, depth_topic)) remark_ += "; the distortion that " + topic + " names is ignored";
    return {cameraFromInfo(info, depth_topic), "from " + topic};
  }

  const rosbag::Bag& bag_;
  const RecordingOptions& options_;
  std::string path_;
  std::vector<BagTopic> topics_;
  std::string remark_;
};

}  // namespace

BagSources findSources(const rosbag::Bag& bag, const RecordingOptions& options) {
  return SourceFinder(bag, options).find();
}

}  // namespace depth_fusion
