#include "ros/bags/open_recording.h"

#include "depth_fusion/acquisition/oni_recording.h"
#include "recording/calibrated_recording.h"

namespace depth_fusion {

bool endsWith(const std::string& path, const std::string& ending) {
  return path.size() > ending.size() && path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
}

std::unique_ptr<Recording> openRecording(const std::string& path, const RecordingOptions& options) {
  if (endsWith(path, ".bag")) return calibrated(openBag(path, options), options);
  if (endsWith(path, ".oni")) return calibrated(openOni(path, options), options);
  return openFolder(path, options);
}

}  // namespace depth_fusion
