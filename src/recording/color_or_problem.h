// Colour that cannot be read costs a frame its colour, not its depth.
#pragma once

#include "depth_fusion/common/error.h"
#include "depth_fusion/frames/rgbd_frame.h"

namespace depth_fusion {

template <class Read>
void readColorOrProblem(RgbdFrame& frame, const Read& read) {
  try {
    frame.color = read();
  } catch (const Error& error) {
    frame.color_problem = error.what();
  }
}

}  // namespace depth_fusion
