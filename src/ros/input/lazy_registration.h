// Registration of a source's frames, which needs no device until a frame has to be changed.
#pragma once

#include <memory>
#include <string>

#include "depth_fusion/registration/frame_registration.h"

namespace depth_fusion {

class LazyRegistration {
 public:
  // device: as ComputeContext has it.
  explicit LazyRegistration(const std::string& device) : device_(device) {}

  // Does what FrameRegistration does. Throws Error without a device, too.
  RgbdFrame process(const RgbdFrame& frame, const RegistrationParameters& parameters);

 private:
  std::string device_;
  std::unique_ptr<ComputeContext> compute_;  // null, as is the next, before the first frame that needs them
  std::unique_ptr<FrameRegistration> registration_;
};

}  // namespace depth_fusion
