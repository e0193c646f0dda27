// Writes an RGB-D sequence as a recording that the readers, and other tools, read back.
#pragma once

#include <memory>
#include <string>

#include "depth_fusion/frames/rgbd_frame.h"

namespace depth_fusion {

class RecordingWriter {
 public:
  virtual ~RecordingWriter() = default;

  // Appends a frame; depth must be CV_16UC1. Throws Error, naming the file, if it cannot be written.
  virtual void write(const RgbdFrame& frame) = 0;

  // Writes what only the end is known of (lists, reference trajectory, index). Throws Error as write() does.
  virtual void finish() = 0;
};

// A folder in the TUM layout: depth/*.png (metres = value / 5000, or in the first frame's unit if that is
// finer), rgb/*.png, depth.txt, rgb.txt, groundtruth.txt (for the frames that have a pose) and camera.yaml
// with the intrinsics and the unit, which openFolder reads back.
std::unique_ptr<RecordingWriter> createTumFolder(const std::string& path);

}  // namespace depth_fusion
