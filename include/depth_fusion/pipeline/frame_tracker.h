// From a frame and the motion of its texture to its pose: preprocessing, ICP tracking, relocalisation.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "depth_fusion/icp_tracking/icp_tracker.h"
#include "depth_fusion/pipeline/pipeline_parameters.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"
#include "depth_fusion/relocalisation/relocaliser.h"
#include "depth_fusion/texture_odometry/texture_odometry.h"

namespace depth_fusion {

class FrameTracker {
 public:
  // The map as seen from T_W_D; valid until the next call.
  using RenderView = std::function<const ModelView&(const Pose& T_W_D)>;

  FrameTracker(ComputeContext& compute, const PipelineParameters& parameters, const CameraIntrinsics& camera,
               RenderView render);

  // For the frames to come. Throws Error if they do not fit together.
  void setParameters(const PipelineParameters& parameters);
  // The first half of tracking, which needs no map: where the frame's texture, by its `motion` against the
  // frame before, says that the sensor is (the last pose without one), and preprocessing. Follows the answer
  // to the frame before.
  MotionPrior prepare(const RgbdFrame& frame, const TextureOdometryResult& motion, StageTimers& timers);
  // The prepared frame's pose by its depth against `view`, the model view of the last fused frame (null
  // before the first one: then the frame gets the pose `start`). `features` are those of its texture. A lost
  // frame and those after it are tried against keyframes and against the last pose, until one fits. Every
  // result is to be answered by accept or reject.
  TrackingResult track(const RgbdFrame& frame, const MotionPrior& prior, const FrameFeatures& features,
                       const ModelView* view, StageTimers& timers, const Pose& start = Pose::Identity());
  // Takes the pose as the one that the next frame is predicted from, and the frame as a keyframe if none is
  // near.
  void accept(const RgbdFrame& frame, const FrameFeatures& features, const Pose& T_W_D);
  // The frame is lost.
  void reject();

  // Preprocesses a frame whose pose is known from elsewhere; the next one is predicted from there.
  void follow(const RgbdFrame& frame, const Pose& T_W_D, StageTimers& timers);
  // A frame that is not tracked, for want of time: the next one is predicted from where its texture moved.
  void skip(double stamp_s, const TextureOdometryResult& motion);
  // Forgets everything.
  void reset();
  // Lost, and last seen there.
  void expectAt(const Pose& T_W_D);

  // The last frame, preprocessed.
  std::shared_ptr<const DepthFrame> depth() const { return preprocessor_.result(); }
  size_t keyframeCount() const { return relocaliser_.keyframes().size(); }

 private:
  // The texture's motion since the frame before; the last pose without one. Updates the velocity.
  MotionPrior predict(double stamp_s, const TextureOdometryResult& motion);
  // `start`, if the frame has enough depth for the next one to be tracked against.
  TrackingResult begin(const RgbdFrame& frame, const Pose& start) const;
  // Against the model seen from where keyframes, or after a loss the prior, say that the sensor is. `lost`
  // without one.
  TrackingResult relocalise(const DepthFrame& depth, const FrameFeatures& features, const MotionPrior& prior,
                            const TrackingResult& lost, StageTimers& timers);
  TrackingResult trackFrom(const MotionPrior& prior, const DepthFrame& depth, StageTimers& timers);
  void moveTo(double stamp_s, const Pose& T_W_D);

  ComputeContext& compute_;
  PipelineParameters parameters_;
  RenderView render_;
  DepthPreprocessor preprocessor_;
  IcpTracker tracker_;
  Relocaliser relocaliser_;
  TextureOdometry matcher_;             // to keyframes
  std::optional<StampedPose> tracked_;  // the frame before; none if that was lost
  Pose T_W_expected_ =
      Pose::Identity();   // the frame before: as tracked last, then as the texture moved on from there
  double stamp_s_ = 0.0;  // of the frame before
  Vector6d velocity_ = Vector6d::Zero();  // of D in D, per second
};

}  // namespace depth_fusion
