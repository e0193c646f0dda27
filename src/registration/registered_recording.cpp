#include "depth_fusion/registration/registered_recording.h"

#include "depth_fusion/registration/frame_registration.h"

namespace depth_fusion {
namespace {

class RegisteredRecording : public Recording {
 public:
  RegisteredRecording(std::unique_ptr<Recording> recording, ComputeContext& compute,
                      const RegistrationParameters& parameters)
      : recording_(std::move(recording)), registration_(compute, parameters) {}

  std::optional<RgbdFrame> next() override {
    std::optional<RgbdFrame> frame = recording_->next();
    if (frame) frame = registration_.process(*frame);
    return frame;
  }

  size_t frameCount() const override { return recording_->frameCount(); }
  std::string description() const override { return recording_->description(); }

 private:
  std::unique_ptr<Recording> recording_;
  FrameRegistration registration_;
};

}  // namespace

std::unique_ptr<Recording> registered(std::unique_ptr<Recording> recording, ComputeContext& compute,
                                      const RegistrationParameters& parameters) {
  return std::make_unique<RegisteredRecording>(std::move(recording), compute, parameters);
}

}  // namespace depth_fusion
