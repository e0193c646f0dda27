#include "ros/bags/bag_topics.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "common/lowered.h"

namespace depth_fusion {
namespace {

constexpr char kCompressedDepthName[] = "compressedDepth";
constexpr char kCompressedName[] = "compressed";
constexpr int kUnranked = 99;

// Whatever the case of its letters.
bool contains(const std::string& text, const std::string& part) {
  return lowered(text).find(part) != std::string::npos;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) {
    if (!part.empty()) parts.push_back(part);
  }
  return parts;
}

std::string lastPart(const std::string& topic) { return topic.substr(topic.rfind('/') + 1); }

std::string parentOf(const std::string& topic) {
  const size_t end = topic.rfind('/');
  return end == std::string::npos ? "" : topic.substr(0, end);
}

// The image's topic without the transport's ending.
std::string baseTopic(const std::string& topic) {
  const std::string last = lastPart(topic);
  return last == kCompressedDepthName || last == kCompressedName ? parentOf(topic) : topic;
}

int sharedNamespaces(const std::string& a, const std::string& b) {
  const std::vector<std::string> parts_a = split(parentOf(baseTopic(a)), '/');
  const std::vector<std::string> parts_b = split(parentOf(baseTopic(b)), '/');
  const size_t shorter = std::min(parts_a.size(), parts_b.size());
  const auto end = parts_a.begin() + static_cast<std::ptrdiff_t>(shorter);
  return static_cast<int>(std::mismatch(parts_a.begin(), end, parts_b.begin()).first - parts_a.begin());
}

bool isRegistered(const std::string& topic) {
  return contains(topic, "depth_registered") || contains(topic, "aligned_depth") ||
         contains(topic, "depth_to_");
}

bool isColorName(const std::string& topic) { return contains(topic, "rgb") || contains(topic, "color"); }

bool isOtherThanDistance(const std::string& topic) {
  const std::array<const char*, 10> words = {"disparity", "ir",   "infra",     "infra1",    "infra2",
                                             "infrared",  "mask", "amplitude", "intensity", "confidence"};
  for (const std::string& name : split(lowered(topic), '/')) {
    for (const std::string& word : split(name, '_')) {
      if (std::find(words.begin(), words.end(), word) != words.end()) return true;
    }
  }
  return false;
}

bool isImage(const BagTopic& topic, const std::string& transport) {
  return topic.type == kImageType ||
         (topic.type == kCompressedImageType && lastPart(topic.name) == transport);
}

template <size_t kCount>
int rankByName(const std::string& topic, const std::array<const char*, kCount>& preferred) {
  const auto found = std::find(preferred.begin(), preferred.end(), lastPart(baseTopic(topic)));
  return found == preferred.end() ? kUnranked : static_cast<int>(found - preferred.begin());
}

bool isDepth(const BagTopic& topic) {
  if (topic.type == kPointCloudType) return true;
  return (isImage(topic, kCompressedDepthName) || isImage(topic, kCompressedName)) &&
         contains(baseTopic(topic.name), "depth") && !isOtherThanDistance(topic.name);
}

// What is compressed as a picture may be a PNG of 16 bits, or no depth any more.
std::array<int, 5> depthRank(const BagTopic& topic) {
  constexpr std::array<const char*, 4> kPreferred = {"image_raw", "image", "image_rect", "image_rect_raw"};
  return {topic.type == kPointCloudType ? 1 : 0, isImage(topic, kCompressedDepthName) ? 0 : 1,
          isRegistered(topic.name) ? 0 : 1, topic.type == kImageType ? 0 : 1,
          rankByName(topic.name, kPreferred)};
}

// The topic of lowest rank among the wanted; the first by name among equals.
template <class Wanted, class Rank>
std::optional<BagTopic> findBest(const std::vector<BagTopic>& topics, const Wanted& wanted,
                                 const Rank& rank) {
  std::optional<BagTopic> best;
  for (const BagTopic& topic : topics) {
    if (!wanted(topic)) continue;
    if (!best || std::make_pair(rank(topic), topic.name) < std::make_pair(rank(*best), best->name))
      best = topic;
  }
  return best;
}

}  // namespace

std::optional<BagTopic> findDepthTopic(const std::vector<BagTopic>& topics) {
  return findBest(topics, isDepth, depthRank);
}

std::vector<std::string> rivalsOf(const BagTopic& depth_topic, const std::vector<BagTopic>& topics) {
  std::vector<std::string> names;
  for (const BagTopic& topic : topics) {
    const bool is_other = baseTopic(topic.name) != baseTopic(depth_topic.name);
    if (is_other && isDepth(topic) && depthRank(topic) == depthRank(depth_topic)) names.push_back(topic.name);
  }
  return names;
}

std::optional<BagTopic> findColorTopic(const std::vector<BagTopic>& topics, const std::string& depth_topic) {
  constexpr std::array<const char*, 4> kPreferred = {"image_color", "image_raw", "image_rect_color", "image"};
  const auto wanted = [](const BagTopic& topic) {
    return isImage(topic, kCompressedName) && isColorName(topic.name) && !contains(topic.name, "depth") &&
           !isOtherThanDistance(topic.name);
  };
  const auto rank = [&](const BagTopic& topic) {
    return std::array<int, 3>{-sharedNamespaces(topic.name, depth_topic), topic.type == kImageType ? 0 : 1,
                              rankByName(topic.name, kPreferred)};
  };
  return findBest(topics, wanted, rank);
}

std::string ownInfoTopic(const std::vector<BagTopic>& topics, const std::string& depth_topic) {
  const std::string parent = parentOf(baseTopic(depth_topic));
  for (const std::string& name : {parent + "/camera_info", viewerStream(depth_topic) + "/info/camera_info"}) {
    const bool found = std::any_of(topics.begin(), topics.end(), [&](const BagTopic& topic) {
      return topic.type == kCameraInfoType && topic.name == name;
    });
    if (found) return name;
  }
  return "";
}

std::string viewerStream(const std::string& image_topic) { return parentOf(parentOf(image_topic)); }

std::vector<std::string> relatedInfoTopics(const std::vector<BagTopic>& topics,
                                           const std::string& depth_topic) {
  const bool registered = isRegistered(depth_topic);
  std::vector<std::pair<std::array<int, 2>, std::string>> ranked;
  for (const BagTopic& topic : topics) {
    const int shared = sharedNamespaces(topic.name, depth_topic);
    if (topic.type != kCameraInfoType || shared == 0) continue;
    const bool is_likely = isColorName(topic.name) == registered;
    ranked.push_back({{-shared, is_likely ? 0 : 1}, topic.name});
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<std::string> names;
  for (const auto& entry : ranked) names.push_back(entry.second);
  return names;
}

std::string listTopics(const std::vector<BagTopic>& topics) {
  std::string text;
  for (const BagTopic& topic : topics)
    text += (text.empty() ? "" : ", ") + topic.name + " [" + topic.type + "]";
  return text.empty() ? "no topic at all" : text;
}

}  // namespace depth_fusion
