#include "recording/recording_intrinsics.h"

#include <sstream>

#include "depth_fusion/common/error.h"
#include "depth_fusion/geometry/camera_check.h"

namespace depth_fusion {
namespace {

void checkSize(cv::Size size, const CameraIntrinsics& camera, const std::string& where,
               const std::string& source) {
  check(size.width == camera.width && size.height == camera.height,
        where + ": the depth is " + sizeText(size.width, size.height) + " but its intrinsics" + source +
            " are for " + sizeText(camera.width, camera.height) + "; give the right ones with --intrinsics");
}

}  // namespace

RecordingIntrinsics chooseIntrinsics(const std::optional<CameraIntrinsics>& given,
                                     const std::optional<RecordingIntrinsics>& own, cv::Size depth_size,
                                     const std::string& recording) {
  check(given || own, recording + ": nothing says the intrinsics of the " +
                          sizeText(depth_size.width, depth_size.height) +
                          " depth; give them with --intrinsics");
  RecordingIntrinsics chosen = given ? RecordingIntrinsics{*given, "as given"} : *own;
  if (chosen.camera.width == 0 && chosen.camera.height == 0) {
    chosen.camera.width = depth_size.width;
    chosen.camera.height = depth_size.height;
  }
  checkSize(depth_size, chosen.camera, recording, " (" + chosen.source + ")");
  const std::string problem = cameraProblem(chosen.camera);
  check(problem.empty(), recording + ": the intrinsics (" + describe(chosen) + ") are not valid: " + problem +
                             "; give the right ones with --intrinsics");
  return chosen;
}

void checkDepthSize(const cv::Mat& depth, const CameraIntrinsics& camera, const std::string& image) {
  checkSize(depth.size(), camera, image, "");
}

std::string describe(const RecordingIntrinsics& intrinsics) {
  std::ostringstream text;
  const CameraIntrinsics& camera = intrinsics.camera;
  text << camera.fx << ' ' << camera.fy << ' ' << camera.cx << ' ' << camera.cy << ", " << intrinsics.source;
  if (camera.fy < 0.0) text << " (y is up: it is turned down, and so are poses)";
  return text.str();
}

}  // namespace depth_fusion
