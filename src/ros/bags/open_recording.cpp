#include "ros/bags/open_recording.h"

#include <filesystem>

#include "depth_fusion/acquisition/oni_recording.h"
#include "recording/calibrated_recording.h"
#include "ros/bags/bag_file.h"

namespace depth_fusion {

bool endsWith(const std::string& path, const std::string& ending) {
  return path.size() > ending.size() && path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
}

std::string namesOf(const std::vector<std::string>& paths) {
  std::string names;
  for (const std::string& path : paths) names += (names.empty() ? "" : " ") + path;
  return names;
}

std::unique_ptr<Recording> openRecording(const std::string& path, const RecordingOptions& options) {
  return openRecordings({path}, options);
}

std::unique_ptr<Recording> openRecordings(const std::vector<std::string>& paths,
                                          const RecordingOptions& options) {
  const std::string& path = paths.front();
  std::error_code unreadable;
  const bool is_file = std::filesystem::is_regular_file(path, unreadable);
  if (endsWith(path, ".bag") || (is_file && isBagFile(path)))
    return calibrated(openBags(paths, options), options);
  check(paths.size() == 1, path + ": only bags can be read as one; give one recording");
  if (endsWith(path, ".oni")) return calibrated(openOni(path, options), options);
  check(!endsWith(path, ".db3") && !endsWith(path, ".mcap"),
        path + ": is a bag of ROS 2; convert it with: rosbags-convert --src FOLDER --dst FILE.bag");
  return openFolder(path, options);
}

}  // namespace depth_fusion
