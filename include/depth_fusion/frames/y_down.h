// Recordings whose cameras and world have y up (ICL-NUIM): a negative fy says so. Everything else here has y
// down.
#pragma once

#include "depth_fusion/frames/rgbd_frame.h"

namespace depth_fusion {

// The pose of a camera with y up in a world with y up, between the same two with y down.
Pose mirroredY(const Pose& pose);

// Makes fy of both cameras positive and mirrors T_W_D and T_C_D, if the depth camera's fy is negative, and
// marks the frame as y_mirrored. The images are the same either way.
void makeYDown(RgbdFrame& frame);

}  // namespace depth_fusion
