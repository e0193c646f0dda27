// Registration: frames as sensors give them become frames as the other stages take them. Lens distortion is
// taken out of depth and colour, depth units are set right, and, if wanted, depth is moved to the colour
// camera.
#pragma once

#include <memory>

#include "depth_fusion/compute/compute_context.h"
#include "depth_fusion/frames/rgbd_frame.h"
#include "depth_fusion/registration/registration_parameters.h"

namespace depth_fusion {

// True if the frame's images have to be changed.
bool needsRegistration(const RgbdFrame& frame, const RegistrationParameters& parameters);

// Sets the depth's units as the parameters say, and changes nothing else.
RgbdFrame withDepthUnit(const RgbdFrame& frame, const RegistrationParameters& parameters);

// The camera that depth is moved to: the colour camera, halved until a pixel is not much finer than one of
// the depth camera.
CameraIntrinsics registeredCamera(const CameraIntrinsics& color_camera, const CameraIntrinsics& depth_camera);

class FrameRegistration {
 public:
  FrameRegistration(ComputeContext& compute, const RegistrationParameters& parameters);
  ~FrameRegistration();

  // Counts for the frames to come.
  void setParameters(const RegistrationParameters& parameters);
  // Gives the frame as pinhole cameras see it. Depth that had to be changed is CV_32FC1 in metres,
  // interpolated only within a surface; with depth_to_color it is the colour camera's, where near things hide
  // far ones and what only the colour camera sees has no depth. What is right as it is shares the frame's
  // memory. T_W_D stays the pose of the depth's camera. Colour whose distortion cannot be undone is left out,
  // and color_problem says why. Throws Error for depth whose distortion cannot be undone, of another size
  // than its camera, or with weights where it has to be changed.
  RgbdFrame process(const RgbdFrame& frame);

 private:
  struct Depth;
  struct Color;

  void rectifyColor(RgbdFrame& frame);

  ComputeContext& compute_;
  RegistrationParameters parameters_;
  std::unique_ptr<Depth> depth_;  // null before the first frame that needs them
  std::unique_ptr<Color> color_;
};

}  // namespace depth_fusion
