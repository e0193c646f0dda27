// Conversions to the argument structs that host and kernels share.
#pragma once

#include "depth_fusion/geometry/camera_intrinsics.h"
#include "depth_fusion/geometry/pose.h"
#include "shared/types.h"

namespace depth_fusion {

inline int pitchOf(int width) { return (width + 15) / 16 * 16 + IMAGE_GUARD; }

// Elements of an image.
inline size_t imageElements(const CameraIntrinsics& camera) {
  return static_cast<size_t>(pitchOf(camera.width)) * camera.height + 2 * IMAGE_GUARD;
}

// Vectors of simd_width pixels that cover a row.
inline size_t vectorsAcross(const CameraIntrinsics& camera, int simd_width) {
  return (camera.width + simd_width - 1) / simd_width;
}

inline CameraArgs toArgs(const CameraIntrinsics& camera) {
  return {static_cast<float>(camera.fx),
          static_cast<float>(camera.fy),
          static_cast<float>(camera.cx),
          static_cast<float>(camera.cy),
          camera.width,
          camera.height,
          pitchOf(camera.width)};
}

inline TransformArgs toArgs(const Pose& T_A_B) {
  TransformArgs args{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      args.rotation[3 * row + column] = static_cast<float>(T_A_B.linear()(row, column));
    }
    args.translation[row] = static_cast<float>(T_A_B.translation()(row));
  }
  return args;
}

}  // namespace depth_fusion
