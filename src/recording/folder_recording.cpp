#include "recording/folder_recording.h"

#include <filesystem>

#include "depth_fusion/common/error.h"
#include "depth_fusion/geometry/camera_check.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "recording/calibrated_recording.h"
#include "recording/camera_file.h"

namespace depth_fusion {

void readCamera(const std::string& path, RecordingOptions& options) {
  const CameraFile file = readCameraFile(path);
  options.intrinsics = file.camera;
  options.distortion = file.distortion;
  if (file.depth_scale) options.depth_unit_m = 1.0 / *file.depth_scale;
}

void readColorCamera(const std::string& path, RecordingOptions& options) {
  const CameraFile file = readCameraFile(path);
  const std::string problem = cameraProblem(file.camera);
  check(problem.empty(), path + ": the intrinsics are not valid: " + problem + "; correct them");
  options.color_intrinsics = file.camera;
  options.color_distortion = file.distortion;
  options.T_C_D = file.T_C_D;
}

std::unique_ptr<Recording> openFolder(const std::string& path, const RecordingOptions& options) {
  std::error_code unreadable;
  check(std::filesystem::exists(path, unreadable), path + ": there is no such folder; check the path");
  check(std::filesystem::is_directory(path, unreadable),
        path + ": is no recording; give a .bag file or a folder in the TUM or 7-Scenes layout");
  const bool is_empty = std::filesystem::is_empty(path, unreadable);
  check(!unreadable, path + ": the folder cannot be read: " + unreadable.message());
  check(!is_empty, path + ": the folder is empty; give one in the TUM or 7-Scenes layout");
  if (hasTumLayout(path)) return calibrated(openTumFolder(path, options), options);
  if (hasSevenScenesLayout(path)) return calibrated(openSevenScenesFolder(path, options), options);
  throw Error(path +
              ": is no recording; expected depth.txt or associations.txt (TUM layout) or "
              "frame-000000.depth.png (7-Scenes layout)");
}

Trajectory readPoses(const std::string& file_or_folder, std::string* remark) {
  if (!std::filesystem::is_directory(file_or_folder)) return readTrajectory(file_or_folder, remark);
  if (hasTumLayout(file_or_folder)) return readTrajectory(file_or_folder + "/groundtruth.txt", remark);
  Trajectory poses;
  if (hasSevenScenesLayout(file_or_folder)) poses = readSevenScenesPoses(file_or_folder, remark);
  check(!poses.empty(), file_or_folder + ": the folder holds no poses; give a file in the TUM format");
  return poses;
}

}  // namespace depth_fusion
