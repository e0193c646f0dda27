#include "ros/input/lazy_registration.h"

#include "ros/in_process/shared_map.h"

namespace depth_fusion {

RgbdFrame LazyRegistration::process(const RgbdFrame& frame, const RegistrationParameters& parameters) {
  if (!needsRegistration(frame, parameters)) return withDepthUnit(frame, parameters);
  if (registration_ == nullptr) {
    compute_ = sharedCompute(device_)->anotherQueue();
    registration_ = std::make_unique<FrameRegistration>(*compute_, parameters);
  }
  registration_->setParameters(parameters);
  return registration_->process(frame);
}

}  // namespace depth_fusion
