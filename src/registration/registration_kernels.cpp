#include "registration/registration_kernels.h"

#include <limits>

#include "depth_fusion/common/error.h"
#include "geometry/kernel_args.h"

namespace depth_fusion {
namespace {

constexpr float kAnyDepth_m = std::numeric_limits<float>::max();

}  // namespace

LensArgs lensArgs(const CameraIntrinsics& camera, const LensDistortion& lens, const std::string& name) {
  checkDepthLens(lens, name);
  if (!distorts(lens)) return {{}, {}, kAnyDepth_m};
  std::vector<float> k(lens.begin(), lens.end());
  k.resize(8, 0.0f);
  return {{k[0], k[1], k[4], k[5], k[6], k[7]},
          {k[2], k[3]},
          static_cast<float>(maxSquaredRadius(camera, lens, name))};
}

RegistrationKernels::RegistrationKernels(ComputeContext& compute)
    : simd_width_(compute.impl().simd_width),
      splat_(compute),
      from_u16_(compute, "preprocessing/preprocessing.cl", "depth_to_metres_u16"),
      from_f32_(compute, "preprocessing/preprocessing.cl", "depth_to_metres_f32"),
      rectify_(compute, "registration/resample_depth.cl", "rectify_depth"),
      register_(compute, "registration/resample_depth.cl", "register_depth") {}

void RegistrationKernels::depthToMetres(bool is_u16, const DeviceBuffer& input, DeviceBuffer& depth,
                                        const CameraIntrinsics& camera, float unit_m) {
  const RangeArgs range{unit_m, std::numeric_limits<float>::min(), kAnyDepth_m};
  const DeviceBuffer no_offsets;
  (is_u16 ? from_u16_ : from_f32_)
      .run2d(vectorsAcross(camera, simd_width_), camera.height, input, no_offsets, depth, toArgs(camera),
             range);
}

void RegistrationKernels::rectify(const DeviceBuffer& depth, DeviceBuffer& rectified,
                                  const CameraIntrinsics& camera, const LensArgs& lens,
                                  float max_relative_step) {
  rectify_.run2d(vectorsAcross(camera, simd_width_), camera.height, depth, rectified, toArgs(camera), lens,
                 toArgs(camera), max_relative_step);
}

void RegistrationKernels::registerDepth(const DeviceBuffer& depth, const DeviceBuffer& rectified,
                                        DeviceBuffer& splatted, DeviceBuffer& registered,
                                        const CameraIntrinsics& camera, const LensArgs& lens,
                                        const CameraIntrinsics& other_camera, const Pose& T_C_D,
                                        float max_relative_step) {
  splat_.splat(rectified, camera, splatted, other_camera, T_C_D, 1);
  const int radius = DepthSplatKernels::footprint(camera, other_camera) / 2;
  register_.run2d(vectorsAcross(other_camera, simd_width_), other_camera.height, depth, splatted, registered,
                  toArgs(camera), lens, toArgs(other_camera), toArgs(T_C_D.inverse()), radius,
                  max_relative_step);
}

}  // namespace depth_fusion
