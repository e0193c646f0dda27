// Recordings in the layout of the TUM RGB-D benchmark.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "common/io/image_file.h"
#include "depth_fusion/common/error.h"
#include "recording/camera_file.h"
#include "recording/color_or_problem.h"
#include "recording/folder_recording.h"
#include "recording/recording_intrinsics.h"
#include "recording/timed_files.h"
#include "recording/unpaired_color.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kBenchmarkDefault = {640, 480, 525.0, 525.0, 319.5, 239.5};

bool exists(const std::string& path) {
  std::error_code unreadable;
  return std::filesystem::exists(path, unreadable);
}

// associations.txt, associate.txt, rgbd_assoc.txt, ...: the first by name, or an empty path.
std::string findAssociations(const std::string& folder) {
  std::vector<std::string> found;
  std::error_code unreadable;
  for (const auto& entry : std::filesystem::directory_iterator(folder, unreadable)) {
    const std::string name = entry.path().filename().string();
    if (name.find("assoc") != std::string::npos && entry.path().extension() == ".txt")
      found.push_back(entry.path().string());
  }
  return found.empty() ? "" : *std::min_element(found.begin(), found.end());
}

// What the lists of a folder name.
struct TumFiles {
  std::string list;  // the one that names the depth
  std::vector<TimedFile> depth;
  std::vector<TimedFile> color;  // sorted, or where is_paired one for each depth
  bool is_paired = false;
  std::string remark;  // lines that are no entries, colour that is left out
};

TumFiles readPairs(const std::string& list) {
  TumFiles files;
  files.list = list;
  files.is_paired = true;
  for (const TimedPair& pair : readTimedPairs(list, &files.remark)) {
    files.depth.push_back(pair.depth);
    files.color.push_back(pair.color);
  }
  return files;
}

// rgb.txt or, without it, what an association has beside depth.
std::vector<TimedFile> readColor(const std::string& folder, std::string& remark) {
  if (exists(folder + "/rgb.txt")) return readTimedFiles(folder + "/rgb.txt", &remark);
  const std::string associations = findAssociations(folder);
  std::vector<TimedFile> color;
  if (associations.empty()) return color;
  for (const TimedPair& pair : readTimedPairs(associations, &remark)) color.push_back(pair.color);
  std::sort(color.begin(), color.end(),
            [](const TimedFile& a, const TimedFile& b) { return a.stamp_s < b.stamp_s; });
  return color;
}

TumFiles readLists(const std::string& folder) {
  if (!exists(folder + "/depth.txt")) return readPairs(findAssociations(folder));
  TumFiles files;
  files.list = folder + "/depth.txt";
  files.depth = readTimedFiles(files.list, &files.remark);
  try {
    files.color = readColor(folder, files.remark);
  } catch (const Error& error) {
    files.remark += std::string("; colour is left out: ") + error.what();
  }
  return files;
}

// A Kinect's accelerometer has x to the left, y up and z forward.
std::vector<ImuReading> readAccelerometer(const std::string& folder) {
  std::vector<ImuReading> readings;
  std::ifstream file(folder + "/accelerometer.txt");
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    ImuReading reading;
    Eigen::Vector3d force;
    if (!(words >> reading.stamp_s >> force.x() >> force.y() >> force.z())) continue;
    reading.specific_force_D = Eigen::Vector3d(-force.x(), -force.y(), force.z());
    readings.push_back(reading);
  }
  return readings;
}

class TumRecording : public Recording {
 public:
  TumRecording(const std::string& folder, const RecordingOptions& options)
      : folder_(folder),
        max_pairing_gap_s_(options.max_pairing_gap_s),
        files_(readLists(folder)),
        accelerometer_(readAccelerometer(folder)) {
    const std::string camera_path = folder + "/camera.yaml";
    const cv::Size depth_size = depthSize();
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
    if (next_index_ == files_.depth.size()) return std::nullopt;
    const size_t index = next_index_++;
    const TimedFile& depth_file = files_.depth[index];
    RgbdFrame frame;
    frame.stamp_s = depth_file.stamp_s;
    frame.depth = readDepthImage(depth_file.path);
    frame.depth_unit_m = depth_unit_m_;
    frame.intrinsics = intrinsics_.camera;
    frame.distortion = frame.color_distortion = distortion_;
    for (; next_reading_ < accelerometer_.size() && accelerometer_[next_reading_].stamp_s <= frame.stamp_s;
         ++next_reading_)
      frame.readings.imu.push_back(accelerometer_[next_reading_]);
    checkDepthSize(frame.depth, frame.intrinsics, depth_file.path);
    const TimedFile* color_file = colorOf(index);
    if (color_file == nullptr) {
      frame.color_problem = unpaired_.noteUnpaired(nearestColor_s(frame.stamp_s), max_pairing_gap_s_);
      return frame;
    }
    unpaired_.notePaired();
    frame.color_stamp_s = color_file->stamp_s;
    readColorOrProblem(frame, [&] { return readColorImage(color_file->path); });
    return frame;
  }

  size_t frameCount() const override { return files_.depth.size(); }

  std::string description() const override {
    const std::string color = files_.color.empty() ? "no colour (no rgb.txt)"
                                                   : std::to_string(files_.color.size()) + " colour images";
    return "TUM layout, " + folder_ + ": " + std::to_string(files_.depth.size()) + " depth images, " + color +
           ", intrinsics " + describe(intrinsics_) +
           (accelerometer_.empty() ? "" : ", gravity from accelerometer.txt") + files_.remark;
  }

 private:
  cv::Size depthSize() const {
    std::vector<std::string> paths;
    for (const TimedFile& file : files_.depth) paths.push_back(file.path);
    return usualDepthSize(paths, files_.list, files_.remark);
  }

  const TimedFile* colorOf(size_t index) const {
    if (files_.is_paired) return &files_.color[index];
    return nearestFile(files_.color, files_.depth[index].stamp_s, max_pairing_gap_s_);
  }

  // By how much the nearest colour is later.
  std::optional<double> nearestColor_s(double stamp_s) const {
    const TimedFile* color = nearestFile(files_.color, stamp_s, std::numeric_limits<double>::max());
    return color == nullptr ? std::nullopt : std::optional<double>(color->stamp_s - stamp_s);
  }

  std::string folder_;
  double max_pairing_gap_s_;
  TumFiles files_;
  double depth_unit_m_ = 1.0 / kTumDepthScale;
  RecordingIntrinsics intrinsics_;
  LensDistortion distortion_;
  UnpairedColor unpaired_;
  size_t next_index_ = 0;
  std::vector<ImuReading> accelerometer_;
  size_t next_reading_ = 0;
};

}  // namespace

bool hasTumLayout(const std::string& folder) {
  return exists(folder + "/depth.txt") || !findAssociations(folder).empty();
}

std::unique_ptr<Recording> openTumFolder(const std::string& folder, const RecordingOptions& options) {
  return std::make_unique<TumRecording>(folder, options);
}

}  // namespace depth_fusion
