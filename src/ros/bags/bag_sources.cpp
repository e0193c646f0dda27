#include "ros/bags/bag_sources.h"

#include <sensor_msgs/CameraInfo.h>

#include <algorithm>
#include <sstream>

#include "ros/bags/bag_images.h"
#include "ros/bags/bag_transforms.h"
#include "ros/bags/realsense_viewer.h"
#include "ros/conversions/camera_info.h"

namespace depth_fusion {
namespace {

constexpr int kMostInfos = 100;  // looked at, until one fits

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string numberText(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

class SourceFinder {
 public:
  SourceFinder(const BagFiles& bags, const RecordingOptions& options)
      : bags_(bags), options_(options), topics_(bags.topics()) {}

  BagSources find() {
    sources_.depth_topic = depthTopic();
    const ImageSample depth = sampleDepth(bags_, sources_.depth_topic);
    sources_.stamp_lead_s = depth.lead_s;
    sources_.depth_frame = depth.frame_id;
    sources_.depth_unit_m = viewerDepthUnit(bags_, sources_.depth_topic);
    noteUnit(depth);
    notePublishers();
    noteRivals();
    if (options_.intrinsics) {
      sources_.intrinsics = chooseIntrinsics(options_.intrinsics, std::nullopt, depth.size, bags_.name());
    } else if (topicNamed(sources_.depth_topic)->type == kPointCloudType) {
      findCloudCamera();
    } else {
      findDepthCamera(depth.size);
    }
    findColor(depth.frame_id);
    return sources_;
  }

 private:
  std::string depthTopic() const {
    if (!options_.depth_topic.empty()) return givenTopic(options_.depth_topic);
    const auto topic = findDepthTopic(topics_);
    check(topic.has_value(), bags_.name() + ": no depth topic found; the bag holds " + listTopics(topics_) +
                                 "; name one with --depth-topic");
    return topic->name;
  }

  // Null if there is none.
  const BagTopic* topicNamed(const std::string& name) const {
    const auto topic =
        std::find_if(topics_.begin(), topics_.end(), [&](const BagTopic& t) { return t.name == name; });
    return topic == topics_.end() ? nullptr : &*topic;
  }

  std::string givenTopic(const std::string& name) const {
    const BagTopic* topic = topicNamed(name);
    check(topic != nullptr,
          bags_.name() + ": there is no topic " + name + "; the bag holds " + listTopics(topics_));
    check(topic->type == kImageType || topic->type == kCompressedImageType || topic->type == kPointCloudType,
          bags_.name() + ": " + name + " is no topic of images or clouds; the bag holds " +
              listTopics(topics_));
    return name;
  }

  // Organised clouds tell their camera themselves.
  void findCloudCamera() {
    const std::string name = bags_.name() + ": " + sources_.depth_topic;
    useMessage<sensor_msgs::PointCloud2>(sources_.depth_topic, [&](const sensor_msgs::PointCloud2& cloud) {
      sources_.intrinsics = {cameraOfCloud(cloud, name), "from the points of " + sources_.depth_topic};
      depth_camera_.intrinsics = sources_.intrinsics.camera;
    });
  }

  void notePublishers() {
    const std::vector<std::string> publishers = bags_.publishers(sources_.depth_topic);
    if (publishers.size() > 1)
      remark(sources_.depth_topic + " has several publishers (" + joined(publishers) +
             "); if they are several cameras, record one of them alone");
  }

  void noteUnit(const ImageSample& depth) {
    if (depth.is_in_unusual_unit)
      remark("the numbers of " + sources_.depth_topic +
             " are too large for metres and taken for millimetres");
  }

  void noteRivals() {
    if (!options_.depth_topic.empty()) return;
    const std::vector<std::string> rivals = rivalsOf(*findDepthTopic(topics_), topics_);
    if (!rivals.empty()) remark("there is more depth: " + joined(rivals) + " (--depth-topic takes another)");
  }

  // The first message of the topic that `use` takes without an Error; throws that of the first if none is.
  template <class Message, class Use>
  bool useMessage(const std::string& topic, const Use& use) const {
    rosbag::View view;
    bags_.addTo(view, {topic});
    std::string first_problem;
    int looked_at = 0;
    for (auto place = view.begin(); place != view.end() && looked_at < kMostInfos; ++place, ++looked_at) {
      try {
        use(*readMessage<Message>(*place, bags_));
        return true;
      } catch (const Error& error) {
        if (first_problem.empty()) first_problem = error.what();
      }
    }
    check(first_problem.empty(), first_problem);
    return false;
  }

  void findDepthCamera(cv::Size size) {
    const auto takeFrom = [&](const std::string& topic) {
      return useMessage<sensor_msgs::CameraInfo>(
                 topic,
                 [&](const sensor_msgs::CameraInfo& info) {
                   const std::string name = bags_.name() + ": " + topic;
                   depth_camera_ = cameraFromInfo(info, name, sources_.depth_topic, size);
                   checkDepthLens(depth_camera_.lens, name);
                   maxSquaredRadius(depth_camera_.intrinsics, depth_camera_.lens, name);
                   sources_.intrinsics = {depth_camera_.intrinsics, "from " + topic};
                   sources_.distortion = depth_camera_.lens;
                 }) &&
             noteChange(topic, size);
    };
    const std::string own_topic = ownInfoTopic(topics_, sources_.depth_topic);
    bool found = !own_topic.empty() && takeFrom(own_topic);
    for (const std::string& topic : relatedInfoTopics(topics_, sources_.depth_topic)) {
      if (found) break;
      try {
        found = takeFrom(topic);
      } catch (const Error&) {
        // It is another camera's.
      }
    }
    check(found, bags_.name() + ": no camera_info found for " + sources_.depth_topic + "; the bag holds " +
                     listTopics(topics_) + "; give the intrinsics with --intrinsics");
    if (!depth_camera_.remark.empty()) remark(depth_camera_.remark);
  }

  // Says if the camera is another one later. Looks at some messages only, for a bag may be long. True.
  bool noteChange(const std::string& topic, cv::Size size) {
    constexpr size_t kSamples = 20;
    rosbag::View view;
    bags_.addTo(view, {topic});
    size_t place_number = 0;
    const size_t stride = std::max<size_t>(view.size() / kSamples, 1);
    for (auto place = view.begin(); place != view.end(); ++place, ++place_number) {
      const bool is_last = place_number + 1 == view.size();
      if (place_number % stride != 0 && !is_last) continue;
      const auto camera = cameraOf(*place, topic, size);
      if (!camera || sameCamera(camera->intrinsics, depth_camera_.intrinsics)) continue;
      remark(topic + " changes, from a focal length of " + numberText(depth_camera_.intrinsics.fx) + " to " +
             numberText(camera->intrinsics.fx) + "; the first counts for all images");
      break;
    }
    return true;
  }

  // Nothing for a message that is of no use.
  std::optional<CameraModel> cameraOf(const rosbag::MessageInstance& place, const std::string& topic,
                                      cv::Size size) const {
    try {
      return cameraFromInfo(*readMessage<sensor_msgs::CameraInfo>(place, bags_), topic, sources_.depth_topic,
                            size);
    } catch (const Error&) {
      return std::nullopt;
    }
  }

  void findColor(const std::string& depth_frame) {
    const bool given = !options_.color_topic.empty();
    const auto found = findColorTopic(topics_, sources_.depth_topic);
    if (!given && !found) return;
    try {
      sources_.color_topic = given ? givenTopic(options_.color_topic) : found->name;
      const cv::Size size = sampleColor(bags_, sources_.color_topic).size;
      if (!options_.intrinsics && !options_.color_intrinsics) findColorCamera(size, depth_frame);
    } catch (const Error& error) {
      leaveOutColor(error.what());
    }
  }

  // Colour without a camera_info of its own is taken for registered to depth.
  void findColorCamera(cv::Size size, const std::string& depth_frame) {
    const std::string topic = ownInfoTopic(topics_, sources_.color_topic);
    ColorCamera camera;
    std::string color_frame;
    const auto take = [&](const sensor_msgs::CameraInfo* info) {
      camera = colorCameraFromInfo(info, topic, sources_.color_topic, size, depth_camera_);
      check(camera.problem.empty(), camera.problem);
      maxSquaredRadius(camera.intrinsics.value_or(depth_camera_.intrinsics), camera.lens, topic);
      if (info != nullptr && !camera.is_registered) color_frame = info->header.frame_id;
    };
    if (topic.empty() || !useMessage<sensor_msgs::CameraInfo>(
                             topic, [&](const sensor_msgs::CameraInfo& info) { take(&info); }))
      take(nullptr);
    if (!camera.remark.empty()) remark(camera.remark);
    sources_.color_intrinsics = camera.intrinsics;
    sources_.color_distortion = camera.lens;
    sources_.T_C_D = viewerTransform(bags_, sources_.color_topic, sources_.depth_topic);
    if (!sources_.T_C_D && !depth_frame.empty() && !color_frame.empty() && color_frame != depth_frame)
      findColorPose(color_frame, depth_frame);
  }

  void findColorPose(const std::string& color_frame, const std::string& depth_frame) {
    sources_.T_C_D = transformIn(bags_, color_frame, depth_frame);
    if (!sources_.T_C_D)
      leaveOutColor("it is in the frame " + color_frame + ", depth in " + depth_frame +
                    ", and the bag's tf does not connect them; give the colour camera with --color-camera");
  }

  void leaveOutColor(const std::string& reason) {
    sources_.color_topic.clear();
    remark("colour is left out: " + reason);
  }

  void remark(const std::string& text) { sources_.remark += "; " + text; }

  const BagFiles& bags_;
  const RecordingOptions& options_;
  std::vector<BagTopic> topics_;
  CameraModel depth_camera_;
  BagSources sources_;
};

}  // namespace

BagSources findSources(const BagFiles& bags, const RecordingOptions& options) {
  return SourceFinder(bags, options).find();
}

}  // namespace depth_fusion
