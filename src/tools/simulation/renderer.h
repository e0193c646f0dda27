// Ideal images of a scene.
#pragma once

#include <functional>
#include <opencv2/core.hpp>

#include "depth_fusion/geometry/camera_intrinsics.h"
#include "tools/simulation/scene.h"

namespace depth_fusion {

struct RenderedView {
  cv::Mat depth_m;        // CV_32FC1, z along the optical axis, 0 where nothing is hit or glass hides it
  cv::Mat color;          // CV_8UC3 BGR
  cv::Mat cos_incidence;  // CV_32FC1, cosine of the angle between viewing ray and surface normal
};

// Sphere-traces the scene's distance function; depth is exact to micrometres.
RenderedView render(const Scene& scene, const CameraIntrinsics& camera, const Pose& T_W_D);

// Renders each row from its own pose, as a rolling shutter does.
RenderedView renderRows(const Scene& scene, const CameraIntrinsics& camera,
                        const std::function<Pose(int row)>& T_W_D);

}  // namespace depth_fusion
