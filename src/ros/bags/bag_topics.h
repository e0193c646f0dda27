// Which topics of a bag hold depth, colour and intrinsics, by type and name.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace depth_fusion {

struct BagTopic {
  std::string name;
  std::string type;  // "sensor_msgs/Image"
};

constexpr char kImageType[] = "sensor_msgs/Image";
constexpr char kCompressedImageType[] = "sensor_msgs/CompressedImage";
constexpr char kPointCloudType[] = "sensor_msgs/PointCloud2";
constexpr char kCameraInfoType[] = "sensor_msgs/CameraInfo";

// The best image topic with depth in its name: registered before others, raw before compressed. Without one,
// a topic of point clouds.
std::optional<BagTopic> findDepthTopic(const std::vector<BagTopic>& topics);

// Topics that are no worse than it but for their names: those of other cameras.
std::vector<std::string> rivalsOf(const BagTopic& depth_topic, const std::vector<BagTopic>& topics);

// The best image topic with rgb or color in its name: in the namespace nearest to the depth's, raw before
// compressed.
std::optional<BagTopic> findColorTopic(const std::vector<BagTopic>& topics, const std::string& depth_topic);

// The camera_info topic beside the images, in their very namespace or, as RealSense Viewer records it, in
// `info` beside it, or an empty name.
std::string ownInfoTopic(const std::vector<BagTopic>& topics, const std::string& depth_topic);

// What RealSense Viewer's topics of the images' stream begin with: "/device_0/sensor_0/Depth_0".
std::string viewerStream(const std::string& image_topic);

// The camera_info topics of the depth's outermost namespace, the likeliest first.
std::vector<std::string> relatedInfoTopics(const std::vector<BagTopic>& topics,
                                           const std::string& depth_topic);

// "/a [sensor_msgs/Image], /b [...]".
std::string listTopics(const std::vector<BagTopic>& topics);

}  // namespace depth_fusion
