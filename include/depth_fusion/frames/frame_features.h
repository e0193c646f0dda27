// The features of one colour image, with the surface under them: what a frame, or a keyframe, is matched by.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "depth_fusion/frames/depth_sensor.h"
#include "depth_fusion/geometry/camera_intrinsics.h"
#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// BRIEF: 256 comparisons of brightness.
using BriefDescriptor = std::array<uint64_t, 4>;

constexpr int kPatchRadius_px = 5;
constexpr int kPatchSize_px = 2 * kPatchRadius_px + 3;  // with a border for the gradients
using FeaturePatch = std::array<uint8_t, kPatchSize_px * kPatchSize_px>;

struct Feature {
  int level = 0;
  cv::Point pixel;  // of the level's image
  BriefDescriptor descriptor{};
  FeaturePatch patch{};  // of the level's image, about the pixel
  // The plane through the depth about the pixel: surface . p_C = 1. None at depth edges and without depth.
  std::optional<Eigen::Vector3d> surface_C;
};

struct FrameFeatures {
  std::string reason;       // why there are no features; empty otherwise
  CameraIntrinsics camera;  // of the colour camera
  Pose T_C_D = Pose::Identity();
  DepthSensorParameters depth_sensor;  // the depth's noise
  std::vector<Feature> features;
  std::vector<cv::Mat> smoothed_levels;  // grey; needed of the current frame only, a keyframe can drop them
};

}  // namespace depth_fusion
