// Parts that several kinds of rows have.
#pragma once

#include <cmath>

#include "common/io/bytes.h"
#include "depth_fusion/geometry/camera_intrinsics.h"
#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

inline void write(ByteWriter& bytes, const Pose& pose) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) bytes.number(pose.matrix()(row, column));
  }
}

inline Pose readPose(ByteReader& bytes) {
  Pose pose = Pose::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) pose.matrix()(row, column) = bytes.number<double>();
  }
  const Eigen::Matrix3d square = pose.linear() * pose.linear().transpose();
  check(pose.matrix().allFinite() && square.isIdentity(1e-6) && pose.linear().determinant() > 0.0,
        bytes.where() + " has a pose that is none");
  return pose;
}

inline void write(ByteWriter& bytes, const CameraIntrinsics& camera) {
  bytes.number(camera.width);
  bytes.number(camera.height);
  for (const double value : {camera.fx, camera.fy, camera.cx, camera.cy}) bytes.number(value);
}

inline CameraIntrinsics readCamera(ByteReader& bytes) {
  CameraIntrinsics camera;
  camera.width = bytes.number<int>();
  camera.height = bytes.number<int>();
  bool is_finite = true;
  for (double* value : {&camera.fx, &camera.fy, &camera.cx, &camera.cy}) {
    *value = bytes.number<double>();
    is_finite = is_finite && std::isfinite(*value);
  }
  constexpr int kMaxSize_px = 16384;
  check(is_finite && camera.valid() && camera.width <= kMaxSize_px && camera.height <= kMaxSize_px,
        bytes.where() + " has a camera that is none");
  return camera;
}

// A list's length, of which every element takes so many bytes at least.
inline size_t readCount(ByteReader& bytes, size_t least_bytes) {
  const size_t count = bytes.number<uint32_t>();
  check(count * least_bytes <= bytes.left(), bytes.where() + " ends too early");
  return count;
}

inline void checkAtEnd(const ByteReader& bytes) {
  check(bytes.left() == 0, bytes.where() + " is longer than what it holds");
}

}  // namespace depth_fusion
