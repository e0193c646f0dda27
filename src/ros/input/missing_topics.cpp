#include "ros/input/missing_topics.h"

namespace depth_fusion {

std::string missingText(const std::vector<AwaitedTopic>& awaited, const PublishedTopics& published) {
  std::string text;
  for (const AwaitedTopic& topic : awaited) {
    if (published.contains(topic.name)) continue;
    text += (text.empty() ? "" : "; ") + ("nobody publishes " + topic.name);
    for (const std::string& type : topic.types)
      text += (&type == &topic.types.front() ? "; published are of " : ", of ") + type + ": " +
              published.namesOf(type);
    text += "; give the right one by " + topic.argument + ":=, relative to the launch file's camera:=";
  }
  return text;
}

}  // namespace depth_fusion
