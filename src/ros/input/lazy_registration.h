// Registration of a source's frames, which needs no device until a frame has to be changed.
#pragma once

#include <memory>
#include <string>

#include "depth_fusion/registration/frame_registration.h"

namespace depth_fusion {

class LazyRegistration {
 public:
  // device: as ComputeContext has it.
  LazyRegistration(const std::string& device, const RegistrationParameters& parameters)
      : device_(device), parameters_(parameters) {}

  // For the frames to come.
  void setParameters(const RegistrationParameters& parameters);
  // As FrameRegistration does. Throws Error without a device, too.
  RgbdFrame process(const RgbdFrame& frame);

 private:
  std::string device_;
  RegistrationParameters parameters_;
  std::unique_ptr<ComputeContext> compute_;  // null, as is the next, before the first frame that needs them
  std::unique_ptr<FrameRegistration> registration_;
};

}  // namespace depth_fusion
