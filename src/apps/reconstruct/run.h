// What `reconstruct` does once its options are known.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "depth_fusion/recording/recording.h"

namespace depth_fusion {

struct RunOptions {
  std::vector<std::string> inputs;  // several bags are the parts of one recording
  std::string output;
  std::string trajectory_file;
  std::string device;
  std::string map;                   // where the map is saved in the end; empty: nowhere
  std::string continued;             // a map to go on with; empty: none
  std::shared_ptr<Database> stored;  // that map, open
  size_t max_frames = 0;             // 0 = all
  bool no_mesh = false;
  bool report = false;          // report.html is written
  bool view = false;            // a window shows the scan while it grows
  bool self_calibrate = false;  // from the recording, before it is fused
  bool single_pass = false;     // loops are not sought
  RecordingOptions recording;
  PipelineParameters parameters;
};

// Fuses the recording, once more if loops move its poses, and writes mesh, trajectory and report. Returns the
// exit status: 1 if a frame could not be read, most were lost, the pool was full, or a file could not be
// written, each said on standard error. Throws Error if nothing can start.
int reconstruct(const RunOptions& options);

}  // namespace depth_fusion
