// What tracking among nodelets is told.
#pragma once

#include <string>

#include "depth_fusion/pipeline/pipeline_parameters.h"

namespace depth_fusion {

struct LiveTrackerParameters {
  PipelineParameters pipeline;  // those of texture odometry come with the frames
  std::string device;
  bool use_texture = true;  // false: frames come without texture
  std::string on_clock_jump = "reset";

  // All rows but those of the pipeline, whose stages have tables of their own.
  ParameterTable table();
  bool resetsOnClockJump() const { return on_clock_jump == "reset"; }
};

}  // namespace depth_fusion
