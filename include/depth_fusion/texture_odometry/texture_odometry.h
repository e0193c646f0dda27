// Texture odometry: the motion between two frames from features of their colour images (the paper's section
// "Cooperation with CPU Registration").
#pragma once

#include <string>

#include "depth_fusion/common/parameters.h"
#include "depth_fusion/geometry/motion_prior.h"
#include "depth_fusion/recording/rgbd_frame.h"
#include "depth_fusion/texture_odometry/frame_features.h"

namespace depth_fusion {

struct TextureOdometryParameters {
  bool enabled = true;
  int levels = 3;
  int cell_size_px = 40;
  int features_per_cell = 3;
  int corner_threshold = 20;
  int weak_corner_threshold = 7;
  int min_features = 30;
  int min_matches = 20;
  int min_inliers = 15;
  float min_inlier_fraction = 0.15f;
  int max_descriptor_distance = 70;
  float search_radius_px = 120.0f;
  int ransac_iterations = 300;
  float coarse_inlier_px = 3.0f;
  float fine_inlier_px = 1.5f;
  float inlier_depth_sigmas = 4.0f;
  float sigma_scale = 15.0f;

  ParameterTable table();
};

struct TextureOdometryResult {
  bool found = false;
  std::string reason;                          // why no motion was found; empty otherwise
  Pose T_previous_current = Pose::Identity();  // depth camera frames; valid if found
  Matrix6d covariance = Matrix6d::Zero();  // of the twist (rotation, translation) applied to it on the left
  int features = 0;                        // of the current frame
  int matches = 0;
  int inliers = 0;

  // The current frame's pose, if the previous one's is known exactly.
  MotionPrior priorFrom(const Pose& T_W_previous) const;
};

class TextureOdometry {
 public:
  explicit TextureOdometry(const TextureOdometryParameters& parameters,
                           const DepthSensorParameters& sensor = {});

  // For the frames to come.
  void setParameters(const TextureOdometryParameters& parameters, const DepthSensorParameters& sensor);

  // The motion against the frame of the last call.
  TextureOdometryResult process(const RgbdFrame& frame);
  void reset();

  // The features of the last call's frame.
  const FrameFeatures& previous() const { return previous_; }

  FrameFeatures extract(const RgbdFrame& frame) const;
  // The motion of `current` against `reference`, which may be a keyframe: anywhere_in_image lifts the limit
  // on how far a feature moves.
  TextureOdometryResult match(const FrameFeatures& reference, const FrameFeatures& current,
                              bool anywhere_in_image = false) const;

 private:
  TextureOdometryParameters parameters_;
  DepthSensorParameters sensor_;
  FrameFeatures previous_;
};

}  // namespace depth_fusion
