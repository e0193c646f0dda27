#include "tools/report/advice.h"

#include "depth_fusion/common/percentile.h"
#include "tools/report/html.h"

namespace depth_fusion {
namespace {

// Beyond or below these shares it is worth a word.
constexpr double kManyDegenerate = 0.05, kLittleExplained = 0.6, kLittleColored = 0.9, kFullPool = 0.9;
constexpr double kLive_ms = 33.0;  // a frame at 30 Hz

class Advice {
 public:
  explicit Advice(const RunReport& report) : report_(report), frames_(report.record.frames()) {}

  std::vector<std::string> all() {
    addLost();
    addDegenerate();
    addFit();
    addInput();
    addColor();
    addResources();
    return std::move(advice_);
  }

 private:
  double shareOf(TrackingStatus status) const {
    return static_cast<double>(countOf(frames_, status)) / static_cast<double>(frames_.size());
  }
  void add(const std::string& advice) { advice_.push_back(advice); }

  void addLost() {
    const std::vector<LostFrames> losses = lossesOf(frames_);
    if (losses.empty()) return;
    if (shareOf(TrackingStatus::kLost) > 0.5) {
      add("Most frames were lost. A wrong camera bends the surface until nothing fits: check intrinsics and "
          "depth unit "
          "(`--intrinsics fx,fy,cx,cy`, `--camera FILE`).");
    }
    add("Tracking was lost " + std::to_string(losses.size()) + (losses.size() == 1 ? " time" : " times") +
        ". Look at the frames above: move more slowly there, and keep corners or texture in view. A lost "
        "sensor is found "
        "again where it has been before.");
  }
  void addDegenerate() {
    if (frames_.empty() || shareOf(TrackingStatus::kDegenerate) < kManyDegenerate) return;
    add("In " + percentText(shareOf(TrackingStatus::kDegenerate), 1.0) +
        " of the frames geometry left directions free, as along a bare wall. Have something with corners in "
        "view, or "
        "colour images with texture.");
  }
  void addFit() {
    std::vector<double> explained;
    for (const RecordedFrame& frame : frames_) {
      if (frame.is_tracked && frame.status != TrackingStatus::kLost) explained.push_back(frame.explained);
    }
    const double median = percentile(explained, 0.5);
    if (!explained.empty() && median < kLittleExplained) {
      add("The map explains " + percentText(median, 1.0) +
          " of a frame in the median. The sensor may be noisier than it is taken for (`--params "
          "cfg/SENSOR.yaml` has its "
          "preset), its depth may be off (`scripts/run calibrate`, or `--self-calibrate`), or much of the "
          "scene moved.");
    }
    if (!report_.map_doubt.empty()) {
      add("The map may be wrong: " + report_.map_doubt +
          ". Look at the model there; if two surfaces stand side by side, record that part again.");
    }
  }
  void addInput() {
    if (report_.unreadable == 0) return;
    add(std::to_string(report_.unreadable) +
        " frames could not be read; the messages of `reconstruct` name the files. Copy or record them "
        "again.");
  }
  void addColor() {
    const size_t tracked = frames_.size() - countOf(frames_, TrackingStatus::kLost);
    if (!report_.wants_color) {
      add("The model has no colour: `--color` fuses it, where the recording has colour images.");
    } else if (static_cast<double>(report_.colored) < kLittleColored * static_cast<double>(tracked)) {
      add("Only " + percentText(static_cast<double>(report_.colored), static_cast<double>(tracked)) +
          " of the tracked frames gave colour: their colour images are missing, or too far in time from the "
          "depth.");
    }
  }
  void addResources() {
    const auto frame = report_.stages_ms.find("frame");
    if (frame != report_.stages_ms.end() && percentile(frame->second, 0.5) > kLive_ms) {
      add("A frame takes " + fixed(percentile(frame->second, 0.5), 0) +
          " ms in the median, more than the 33 ms between two of a sensor: live, frames would be left out on "
          "this device. "
          "A larger `--voxel-size`, a smaller `--max-range` or `--device gpu` is faster.");
    }
    if (report_.pool_capacity > 0 &&
        static_cast<double>(report_.pool_blocks) > kFullPool * static_cast<double>(report_.pool_capacity)) {
      add("The voxel pool is nearly full: raise `map/pool_mib`, or `--voxel-size`.");
    }
  }

  const RunReport& report_;
  const std::vector<RecordedFrame>& frames_;
  std::vector<std::string> advice_;
};

}  // namespace

std::vector<std::string> adviceFor(const RunReport& report) { return Advice(report).all(); }

}  // namespace depth_fusion
