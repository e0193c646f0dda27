// A recorded RGB-D sequence, whatever its format, read frame by frame.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "depth_fusion/frames/rgbd_frame.h"

namespace depth_fusion {

class Recording {
 public:
  virtual ~Recording() = default;

  // The next frame in time order, or nothing at the end. Throws Error for a frame that cannot be read; the
  // call after that goes on with the frame that follows.
  virtual std::optional<RgbdFrame> next() = 0;

  // How many frames next() will have given at the end.
  virtual size_t frameCount() const = 0;

  // The format and what was found, in one line, for the user.
  virtual std::string description() const = 0;
};

struct RecordingOptions {
  std::optional<CameraIntrinsics>
      intrinsics;                      // instead of the recording's own (width, height 0: the images')
  LensDistortion distortion;           // with intrinsics; without, the recording's own counts
  std::optional<double> depth_unit_m;  // of depth in 16 bits, instead of the recording's own
  std::optional<CameraIntrinsics> color_intrinsics;  // of a colour camera beside the depth camera
  LensDistortion color_distortion;                   // with color_intrinsics
  std::optional<Pose> T_C_D;                         // with color_intrinsics
  std::string color_problem;                         // why colour is not to be used; empty: it is
  double max_pairing_gap_s = 0.02;                   // colour farther from its depth than this is left out
  std::string depth_topic;                           // bags only; empty: found by type and name
  std::string color_topic;                           // bags only; empty: found by type and name
};

// Reads the intrinsics, the distortion and, if it is said, the depth's unit of a camera file: this package's
// camera.yaml, or a calibration as ROS's camera_calibration writes it. Throws Error naming the file and the
// key that is missing or wrong.
void readCamera(const std::string& path, RecordingOptions& options);
// Reads those of the colour camera. The file may say where it is: `depth_to_color`, a 4x4 matrix that takes
// points of the depth camera to this one (metres).
void readColorCamera(const std::string& path, RecordingOptions& options);

// Opens a folder in the TUM or the 7-Scenes layout, found out by looking. Throws Error for any other path.
std::unique_ptr<Recording> openFolder(const std::string& path, const RecordingOptions& options);

}  // namespace depth_fusion
