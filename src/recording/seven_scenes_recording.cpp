// Recordings in the layout of the 7-Scenes data set.
#include <algorithm>
#include <filesystem>
#include <map>

#include "common/io/image_file.h"
#include "common/io/text_file.h"
#include "depth_fusion/common/error.h"
#include "recording/color_or_problem.h"
#include "recording/folder_recording.h"
#include "recording/matrix_file.h"
#include "recording/recording_intrinsics.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kDataSetDefault = {640, 480, 585.0, 585.0, 320.0, 240.0};
// The data set's colour camera, of which it says nothing: fitted to where colour edges lie beside depth edges
// in redkitchen.
constexpr CameraIntrinsics kDataSetColor = {640, 480, 525.0, 525.0, 320.0, 240.0};
const Vector6d kDataSetColorMotion =
    (Vector6d() << 0.0046, -0.0005, 0.0072, -0.0225, 0.0014, -0.0050).finished();
constexpr double kFrameRate_hz = 30.0;
constexpr double kDepthUnit_m = 0.001;
constexpr int kNoDepth = 65535;
constexpr char kIntrinsicsFile[] = "/camera-intrinsics.txt";

struct FrameFiles {
  std::string depth;
  std::string color;  // empty if there is none
  std::string pose;   // empty if there is none
};

// The number in "frame-NUMBER" and what follows it, or nothing for another name.
std::optional<std::pair<long, std::string>> splitName(const std::string& name) {
  const std::string prefix = "frame-";
  const size_t digits_end = name.find_first_not_of("0123456789", prefix.size());
  if (name.compare(0, prefix.size(), prefix) != 0 || digits_end == std::string::npos) return std::nullopt;
  const size_t digit_count = digits_end - prefix.size();
  if (digit_count == 0 || digit_count > 9) return std::nullopt;
  return std::make_pair(std::stol(name.substr(prefix.size(), digit_count)), name.substr(digits_end));
}

// The frames that have depth, by number.
std::map<long, FrameFiles> listFrames(const std::string& folder) {
  std::map<long, FrameFiles> frames;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const auto name = splitName(entry.path().filename().string());
    if (!name) continue;
    const auto& [index, ending] = *name;
    if (ending == ".depth.png") frames[index].depth = entry.path().string();
    if (ending == ".color.png" || ending == ".color.jpg") frames[index].color = entry.path().string();
    if (ending == ".pose.txt") frames[index].pose = entry.path().string();
  }
  for (auto frame = frames.begin(); frame != frames.end();) {
    frame = frame->second.depth.empty() ? frames.erase(frame) : std::next(frame);
  }
  return frames;
}

// A reference that cannot be read does not cost the frame its depth.
std::optional<Pose> readPoseIfAny(const std::string& path) {
  try {
    return path.empty() ? std::nullopt : readPoseFile(path);
  } catch (const Error&) {
    return std::nullopt;
  }
}

std::optional<RecordingIntrinsics> readIntrinsics(const std::string& folder, cv::Size depth_size) {
  const std::string path = folder + kIntrinsicsFile;
  if (std::filesystem::exists(path)) {
    const std::vector<double> k = readCameraMatrixFile(path);
    return RecordingIntrinsics{{depth_size.width, depth_size.height, k[0], k[4], k[2], k[5]},
                               "from camera-intrinsics.txt"};
  }
  if (depth_size != cv::Size(kDataSetDefault.width, kDataSetDefault.height)) return std::nullopt;
  return RecordingIntrinsics{kDataSetDefault, "the 7-Scenes data set's default"};
}

class SevenScenesRecording : public Recording {
 public:
  SevenScenesRecording(const std::string& folder, const RecordingOptions& options)
      : folder_(folder), frames_(listFrames(folder)), next_(frames_.begin()) {
    const cv::Size depth_size = depthSize();
    intrinsics_ =
        chooseIntrinsics(options.intrinsics, readIntrinsics(folder, depth_size), depth_size, folder);
  }

  std::optional<RgbdFrame> next() override {
    if (next_ == frames_.end()) return std::nullopt;
    const auto& [index, files] = *next_++;
    RgbdFrame frame;
    frame.stamp_s = static_cast<double>(index) / kFrameRate_hz;
    frame.depth = readDepthImage(files.depth);
    frame.depth.setTo(0, frame.depth == kNoDepth);
    frame.depth_unit_m = kDepthUnit_m;
    frame.intrinsics = intrinsics_.camera;
    checkDepthSize(frame.depth, frame.intrinsics, files.depth);
    if (!files.color.empty())
      readColorOrProblem(frame, [&color = files.color] { return readColorImage(color); });
    setColorCamera(frame);
    frame.T_W_D = readPoseIfAny(files.pose);
    return frame;
  }

  size_t frameCount() const override { return frames_.size(); }

  std::string description() const override {
    return "7-Scenes layout, " + folder_ + ": " + std::to_string(frames_.size()) + " depth images, " +
           std::to_string(count(&FrameFiles::color)) + " colour images, " +
           std::to_string(count(&FrameFiles::pose)) + " poses, intrinsics " + describe(intrinsics_);
  }

 private:
  // A recording with the data set's depth camera has its colour camera, too; another's colour fits its depth.
  static void setColorCamera(RgbdFrame& frame) {
    const bool is_data_set = sameCamera(frame.intrinsics, kDataSetDefault) &&
                             frame.color.size() == cv::Size(kDataSetColor.width, kDataSetColor.height);
    if (!is_data_set) return;
    frame.color_intrinsics = kDataSetColor;
    frame.T_C_D = poseFromTwist(kDataSetColorMotion);
  }

  cv::Size depthSize() const {
    std::vector<std::string> paths;
    for (const auto& [index, files] : frames_) paths.push_back(files.depth);
    return usualDepthSize(paths, folder_);
  }

  size_t count(std::string FrameFiles::*file) const {
    return std::count_if(frames_.begin(), frames_.end(),
                         [&](const auto& f) { return !(f.second.*file).empty(); });
  }

  std::string folder_;
  std::map<long, FrameFiles> frames_;
  std::map<long, FrameFiles>::const_iterator next_;
  RecordingIntrinsics intrinsics_;
};

}  // namespace

bool hasSevenScenesLayout(const std::string& folder) { return !listFrames(folder).empty(); }

std::unique_ptr<Recording> openSevenScenesFolder(const std::string& folder, const RecordingOptions& options) {
  return std::make_unique<SevenScenesRecording>(folder, options);
}

Trajectory readSevenScenesPoses(const std::string& folder, std::string* remark) {
  Trajectory poses;
  LeftOut left_out;
  for (const auto& [index, files] : listFrames(folder)) {
    if (files.pose.empty()) continue;
    try {
      if (const auto T_W_D = readPoseFile(files.pose))
        poses.push_back({static_cast<double>(index) / kFrameRate_hz, *T_W_D});
    } catch (const Error& error) {
      left_out.add(error.what());
    }
  }
  const bool is_forgiven = left_out.empty() || (remark != nullptr && !poses.empty());
  check(is_forgiven, left_out.firstProblem());
  if (!left_out.empty()) *remark += left_out.text("pose file");
  return poses;
}

}  // namespace depth_fusion
