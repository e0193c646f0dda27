// Recordings in the layout of the TUM RGB-D benchmark.
#include <filesystem>

#include "common/io/image_file.h"
#include "depth_fusion/common/error.h"
#include "recording/camera_file.h"
#include "recording/color_or_problem.h"
#include "recording/folder_recording.h"
#include "recording/recording_intrinsics.h"
#include "recording/timed_files.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kBenchmarkDefault = {640, 480, 525.0, 525.0, 319.5, 239.5};

bool exists(const std::string& path) {
  std::error_code unreadable;
  return std::filesystem::exists(path, unreadable);
}

cv::Size firstDepthSize(const std::vector<TimedFile>& depth_files, const std::string& list_path) {
  for (const TimedFile& file : depth_files) {
    if (const auto size = pngSize(file.path)) return *size;
  }
  throw Error(list_path + ": none of its " + std::to_string(depth_files.size()) +
              " files is a PNG that can be read; the first is " + depth_files.front().path);
}

std::vector<TimedFile> readColorFiles(const std::string& list_path) {
  if (!exists(list_path)) return {};
  return readTimedFiles(list_path);
}

class TumRecording : public Recording {
 public:
  TumRecording(const std::string& folder, const RecordingOptions& options)
      : folder_(folder),
        max_pairing_gap_s_(options.max_pairing_gap_s),
        depth_files_(readTimedFiles(folder + "/depth.txt")),
        color_files_(readColorFiles(folder + "/rgb.txt")) {
    const std::string camera_path = folder + "/camera.yaml";
    const cv::Size depth_size = firstDepthSize(depth_files_, folder + "/depth.txt");
    std::optional<RecordingIntrinsics> own;
    if (exists(camera_path)) {
      const CameraFile camera_file = readCameraFile(camera_path);
      depth_unit_m_ = 1.0 / camera_file.depth_scale.value_or(kTumDepthScale);
      own = {camera_file.camera, "from camera.yaml"};
      distortion_ = camera_file.distortion;
    } else if (depth_size == cv::Size(kBenchmarkDefault.width, kBenchmarkDefault.height)) {
      own = {kBenchmarkDefault, "the TUM benchmark's default"};
    }
    intrinsics_ = chooseIntrinsics(options.intrinsics, own, depth_size, folder);
  }

  std::optional<RgbdFrame> next() override {
    if (next_index_ == depth_files_.size()) return std::nullopt;
    const TimedFile& depth_file = depth_files_[next_index_++];
    RgbdFrame frame;
    frame.stamp_s = depth_file.stamp_s;
    frame.depth = readDepthImage(depth_file.path);
    frame.depth_unit_m = depth_unit_m_;
    frame.intrinsics = intrinsics_.camera;
    frame.distortion = frame.color_distortion = distortion_;
    checkDepthSize(frame.depth, frame.intrinsics, depth_file.path);
    const TimedFile* color_file = nearestFile(color_files_, depth_file.stamp_s, max_pairing_gap_s_);
    if (color_file == nullptr) return frame;
    frame.color_stamp_s = color_file->stamp_s;
    readColorOrProblem(frame, [&] { return readColorImage(color_file->path); });
    return frame;
  }

  size_t frameCount() const override { return depth_files_.size(); }

  std::string description() const override {
    const std::string color = color_files_.empty() ? "no colour (no rgb.txt)"
                                                   : std::to_string(color_files_.size()) + " colour images";
    return "TUM layout, " + folder_ + ": " + std::to_string(depth_files_.size()) + " depth images, " + color +
           ", intrinsics " + describe(intrinsics_);
  }

 private:
  std::string folder_;
  double max_pairing_gap_s_;
  std::vector<TimedFile> depth_files_;
  std::vector<TimedFile> color_files_;
  double depth_unit_m_ = 1.0 / kTumDepthScale;
  RecordingIntrinsics intrinsics_;
  LensDistortion distortion_;
  size_t next_index_ = 0;
};

}  // namespace

bool hasTumLayout(const std::string& folder) { return exists(folder + "/depth.txt"); }

std::unique_ptr<Recording> openTumFolder(const std::string& folder, const RecordingOptions& options) {
  return std::make_unique<TumRecording>(folder, options);
}

}  // namespace depth_fusion
