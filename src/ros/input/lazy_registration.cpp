#include "ros/input/lazy_registration.h"

#include "ros/in_process/shared_map.h"

namespace depth_fusion {

void LazyRegistration::setParameters(const RegistrationParameters& parameters) {
  parameters_ = parameters;
  if (registration_ != nullptr) registration_->setParameters(parameters);
}

RgbdFrame LazyRegistration::process(const RgbdFrame& frame) {
  if (!needsRegistration(frame, parameters_)) return withDepthUnit(frame, parameters_);
  if (registration_ == nullptr) {
    compute_ = sharedCompute(device_)->anotherQueue();
    registration_ = std::make_unique<FrameRegistration>(*compute_, parameters_);
  }
  return registration_->process(frame);
}

}  // namespace depth_fusion
