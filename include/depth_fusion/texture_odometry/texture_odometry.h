// Texture odometry: the motion between two frames from features of their colour images (the paper's section
// "Cooperation with CPU Registration").
#pragma once

#include <string>

#include "depth_fusion/common/stage_timers.h"
#include "depth_fusion/frames/rgbd_frame.h"
#include "depth_fusion/frames/textured_frame.h"
#include "depth_fusion/texture_odometry/texture_odometry_parameters.h"

namespace depth_fusion {

class TextureOdometry {
 public:
  explicit TextureOdometry(const TextureOdometryParameters& parameters,
                           const DepthSensorParameters& sensor = {});

  // The frames to come are matched by these.
  void setParameters(const TextureOdometryParameters& parameters, const DepthSensorParameters& sensor);

  // Finds the motion against the frame of the last call.
  TextureOdometryResult process(const RgbdFrame& frame);
  // Finds the frame's features and its motion, and takes the time. If texture odometry is not enabled, the
  // result has neither, but says so.
  TexturedFrame texture(const RgbdFrame& frame, StageTimers& timers);
  void reset();

  // Returns the features of the last call's frame.
  const FrameFeatures& previous() const { return previous_; }

  FrameFeatures extract(const RgbdFrame& frame) const;
  // Finds the motion of `current` against `reference`, which may be a keyframe: anywhere_in_image lifts the
  // limit on how far a feature moves.
  TextureOdometryResult match(const FrameFeatures& reference, const FrameFeatures& current,
                              bool anywhere_in_image = false) const;

 private:
  TextureOdometryParameters parameters_;
  DepthSensorParameters sensor_;
  FrameFeatures previous_;
};

}  // namespace depth_fusion
