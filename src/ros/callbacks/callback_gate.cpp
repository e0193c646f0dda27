#include "ros/callbacks/callback_gate.h"

namespace depth_fusion {

CallbackGate::CallbackGate()
    : token_(new std::promise<void>,
             [](std::promise<void>* released) {
               released->set_value();
               delete released;
             }),
      released_(token_->get_future()) {}

ros::WallTimer CallbackGate::createWallTimer(const ros::NodeHandle& handle, ros::WallDuration period,
                                             const ros::WallTimerCallback& callback) const {
  ros::WallTimerOptions options(period, callback, nullptr);
  options.tracked_object = token_;
  return handle.createWallTimer(options);
}

void CallbackGate::close() {
  token_.reset();
  released_.wait();
}

}  // namespace depth_fusion
