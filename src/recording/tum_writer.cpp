// Writes recordings in the layout of the TUM RGB-D benchmark.
#include <algorithm>
#include <filesystem>

#include "common/io/image_file.h"
#include "common/io/text_file.h"
#include "depth_fusion/common/error.h"
#include "depth_fusion/recording/recording_writer.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "recording/camera_file.h"
#include "recording/depth_units.h"

namespace depth_fusion {
namespace {

void makeFolder(const std::string& path) {
  std::error_code failure;
  std::filesystem::create_directories(path, failure);
  check(!failure, path + ": the folder cannot be made: " + failure.message());
}

class TumWriter : public RecordingWriter {
 public:
  explicit TumWriter(const std::string& folder) : folder_(folder) {
    check(!std::filesystem::exists(folder + "/depth.txt"),
          folder + ": already holds a recording; remove it or choose another folder");
    makeFolder(folder + "/depth");
    makeFolder(folder + "/rgb");
  }

  void write(const RgbdFrame& frame) override {
    checkFrame(frame);
    if (!camera_) depth_unit_m_ = std::min(frame.depth_unit_m, 1.0 / kTumDepthScale);
    const std::string stamp = stampText(frame.stamp_s);
    const std::string entry = "/" + stamp + ".png";
    writePng(folder_ + "/depth" + entry, convertDepthUnit(frame.depth, frame.depth_unit_m, depth_unit_m_));
    depth_list_ += stamp + " depth" + entry + '\n';
    if (!frame.color.empty()) {
      writePng(folder_ + "/rgb" + entry, frame.color);
      color_list_ += stamp + " rgb" + entry + '\n';
    }
    if (frame.T_W_D) groundtruth_.push_back({frame.stamp_s, *frame.T_W_D});
    last_stamp_s_ = frame.stamp_s;
    camera_ = frame.intrinsics;
  }

  void finish() override {
    check(camera_.has_value(), folder_ + ": no frame was written to this recording");
    writeCameraFile(folder_ + "/camera.yaml", {*camera_, 1.0 / depth_unit_m_, {}, {}});
    if (!color_list_.empty()) writeText(folder_ + "/rgb.txt", "# timestamp filename\n" + color_list_);
    if (!groundtruth_.empty()) writeTrajectory(folder_ + "/groundtruth.txt", groundtruth_);
    writeText(folder_ + "/depth.txt", "# timestamp filename\n" + depth_list_);
  }

 private:
  void checkFrame(const RgbdFrame& frame) const {
    if (!camera_) return;
    check(frame.stamp_s > last_stamp_s_,
          folder_ + ": a frame's stamp, " + stampText(frame.stamp_s) + ", is not later than the last one's");
    check(sameCamera(frame.intrinsics, *camera_), folder_ + ": the intrinsics change within the recording");
  }

  std::string folder_;
  std::string depth_list_;
  std::string color_list_;
  Trajectory groundtruth_;
  std::optional<CameraIntrinsics> camera_;
  double depth_unit_m_ = 0.0;
  double last_stamp_s_ = 0.0;
};

}  // namespace

std::unique_ptr<RecordingWriter> createTumFolder(const std::string& path) {
  return std::make_unique<TumWriter>(path);
}

}  // namespace depth_fusion
