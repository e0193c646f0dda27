// Typed launches of kernels/registration/.
#pragma once

#include "depth_fusion/geometry/lens_distortion.h"
#include "registration/depth_splat_kernels.h"
#include "shared/types.h"

namespace depth_fusion {

// A lens without coefficients shows every ray.
LensArgs lensArgs(const CameraIntrinsics& camera, const LensDistortion& lens, const std::string& name);

class RegistrationKernels {
 public:
  explicit RegistrationKernels(ComputeContext& compute);

  // input: width * height values of 16 bits (or floats) and at least 16 more.
  void depthToMetres(bool is_u16, const DeviceBuffer& input, DeviceBuffer& depth,
                     const CameraIntrinsics& camera, float unit_m);
  // rectified: an image of the camera, and of the pinhole camera with the same intrinsics.
  void rectify(const DeviceBuffer& depth, DeviceBuffer& rectified, const CameraIntrinsics& camera,
               const LensArgs& lens, float max_relative_step);
  // rectified: the depth without its lens, for what hides what; splatted and registered: images of
  // other_camera.
  void registerDepth(const DeviceBuffer& depth, const DeviceBuffer& rectified, DeviceBuffer& splatted,
                     DeviceBuffer& registered, const CameraIntrinsics& camera, const LensArgs& lens,
                     const CameraIntrinsics& other_camera, const Pose& T_C_D, float max_relative_step);

 private:
  int simd_width_;
  DepthSplatKernels splat_;
  Kernel from_u16_, from_f32_, rectify_, register_;
};

}  // namespace depth_fusion
