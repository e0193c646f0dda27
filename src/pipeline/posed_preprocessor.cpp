#include "depth_fusion/pipeline/posed_preprocessor.h"

#include "pipeline/preprocessing_step.h"

namespace depth_fusion {

const DepthFrame& PosedPreprocessor::process(const RgbdFrame& frame, const Pose& T_W_D, StageTimers& timers) {
  Vector6d velocity = Vector6d::Zero();
  if (before_) velocity = velocityOver(before_->T_W_D.inverse() * T_W_D, frame.stamp_s - before_->stamp_s);
  before_ = {frame.stamp_s, T_W_D};
  return preprocess(compute_, preprocessor_, frame, velocity, timers);
}

}  // namespace depth_fusion
