#include "ros/recording.h"

#include "recording/calibrated_recording.h"

namespace depth_fusion {

std::unique_ptr<Recording> openRecording(const std::string& path, const RecordingOptions& options) {
  const std::string bag_ending = ".bag";
  const bool is_bag = path.size() > bag_ending.size() &&
                      path.compare(path.size() - bag_ending.size(), bag_ending.size(), bag_ending) == 0;
  return is_bag ? calibrated(openBag(path, options), options) : openFolder(path, options);
}

}  // namespace depth_fusion
