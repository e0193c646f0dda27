#include "ros/bags/bag_sources.h"

#include <sensor_msgs/CameraInfo.h>
#include <tf2/buffer_core.h>
#include <tf2/exceptions.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>

#include "ros/bags/bag_images.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

// tf2 takes no names as tf had them.
std::string withoutSlash(const std::string& frame) {
  return frame.empty() || frame[0] != '/' ? frame : frame.substr(1);
}

// T_target_source by the bag's last word on it.
std::optional<Pose> staticTransform(const rosbag::Bag& bag, const std::string& target,
                                    const std::string& source) {
  tf2::BufferCore tf;
  rosbag::View view(bag, rosbag::TopicQuery(std::vector<std::string>{"/tf", "/tf_static"}));
  for (const rosbag::MessageInstance& place : view) {
    for (geometry_msgs::TransformStamped transform :
         readMessage<tf2_msgs::TFMessage>(place, bag)->transforms) {
      transform.header.frame_id = withoutSlash(transform.header.frame_id);
      transform.child_frame_id = withoutSlash(transform.child_frame_id);
      tf.setTransform(transform, "bag", place.getTopic() == "/tf_static");
    }
  }
  try {
    return fromMessage(
        tf.lookupTransform(withoutSlash(target), withoutSlash(source), ros::Time(0)).transform);
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

class SourceFinder {
 public:
  SourceFinder(const rosbag::Bag& bag, const RecordingOptions& options)
      : bag_(bag), options_(options), path_(bag.getFileName()), topics_(topicsOf(bag)) {}

  BagSources find() {
    BagSources sources;
    sources.depth_topic = depthTopic();
    const BagImage depth = firstImage(sources.depth_topic);
    const cv::Size depth_size = toDepth(depth).image.size();
    std::optional<RecordingIntrinsics> own;
    if (!options_.intrinsics) own = infoIntrinsics(sources.depth_topic, depth_size, sources.distortion);
    sources.intrinsics = chooseIntrinsics(options_.intrinsics, own, depth_size, path_);
    sources.color_topic = colorTopic(sources.depth_topic);
    if (own && !options_.color_intrinsics && !sources.color_topic.empty())
      findColorCamera(depth.message.header().frame_id, sources);
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

  RecordingIntrinsics infoIntrinsics(const std::string& depth_topic, cv::Size depth_size,
                                     LensDistortion& distortion) const {
    const auto fromInfo = [&](const sensor_msgs::CameraInfo& info, const std::string& topic) {
      distortion = distortionFromInfo(info, depth_topic);
      return RecordingIntrinsics{cameraFromInfo(info, depth_topic), "from " + topic};
    };
    const std::string own_topic = ownInfoTopic(topics_, depth_topic);
    if (!own_topic.empty()) {
      if (const auto info = firstInfo(own_topic)) return fromInfo(*info, own_topic);
    }
    for (const std::string& topic : relatedInfoTopics(topics_, depth_topic)) {
      const auto info = firstInfo(topic);
      const bool fits = info && static_cast<int>(info->width) == depth_size.width &&
                        static_cast<int>(info->height) == depth_size.height;
      if (fits) return fromInfo(*info, topic);
    }
    throw Error(path_ + ": no camera_info found for " + depth_topic + "; the bag holds " +
                listTopics(topics_) + "; give the intrinsics with --intrinsics");
  }

  // Colour without a camera_info of its own is taken for registered to depth.
  void findColorCamera(const std::string& depth_frame, BagSources& sources) {
    const std::string topic = ownInfoTopic(topics_, sources.color_topic);
    const auto info = topic.empty() ? std::nullopt : firstInfo(topic);
    sources.color_distortion = sources.distortion;
    if (!info || !cameraFromInfo(*info, sources.color_topic).valid()) return;
    const CameraIntrinsics camera = cameraFromInfo(*info, sources.color_topic);
    if (!sameCamera(camera, sources.intrinsics.camera)) sources.color_intrinsics = camera;
    sources.color_distortion = distortionFromInfo(*info, sources.color_topic);
    const std::string color_frame = info->header.frame_id;
    if (depth_frame.empty() || color_frame.empty() || color_frame == depth_frame) return;
    sources.T_C_D = staticTransform(bag_, color_frame, depth_frame);
    if (sources.T_C_D) return;
    sources.color_topic.clear();
    remark_ += "; colour is left out: it is in the frame " + color_frame + ", depth in " + depth_frame +
               ", and the bag's tf does not connect them; give the colour camera with --color-camera";
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
