// A depth image as preprocessing gives it, on the device.
#pragma once

#include <vector>

#include "depth_fusion/compute/device_buffer.h"
#include "depth_fusion/frames/depth_sensor.h"
#include "depth_fusion/geometry/camera_intrinsics.h"

namespace depth_fusion {

// A level of the pyramid, on the device (image layout: kernels/shared/types.h).
struct DepthLevel {
  CameraIntrinsics camera;
  DeviceBuffer depth;  // metres, 0 = none
  DeviceBuffer
      normals;  // unit normals towards the camera in frame D, packed (kernels/shared/normal.h), 0 = none
  DepthSensorParameters sensor = {};  // the depth's noise
};

struct DepthFrame {
  static constexpr int kLevels = 3;

  DeviceBuffer raw_depth;  // metres in range, motion compensated, unfiltered, 0 = none; camera of levels[0]
  DeviceBuffer max_tiles;  // the largest raw depth of each 8x8 tile, row by row
  DeviceBuffer measurements;       // what fusion needs of levels[0]: a word a pixel (kernels/shared/types.h)
  float depth_step_m = 0.0f;       // of the measurements
  std::vector<DepthLevel> levels;  // filtered; full size first, each half the size of the one before

  // The farthest depth that measurements hold.
  float maxRange_m() const;
};

}  // namespace depth_fusion
