// What a camera with a lens sees of a scene.
#pragma once

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "depth_fusion/frames/rgbd_frame.h"
#include "tools/simulation/renderer.h"

namespace depth_fusion {

inline cv::Matx33d cameraMatrix(const CameraIntrinsics& camera) {
  return {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
}

// Returns the rendered view through the lens, made from one at twice the resolution and a quarter more of the
// angle.
inline RenderedView distortedView(const Scene& scene, const CameraIntrinsics& camera,
                                  const LensDistortion& lens, const Pose& T_W_C) {
  CameraIntrinsics wide = camera;
  wide.fx *= 2.0;
  wide.fy *= 2.0;
  wide.width = camera.width * 5 / 2;
  wide.height = camera.height * 5 / 2;
  wide.cx = 2.0 * camera.cx + 0.25 * camera.width;
  wide.cy = 2.0 * camera.cy + 0.25 * camera.height;
  RenderedView view = render(scene, wide, T_W_C);
  std::vector<cv::Point2d> pixels, sources;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) pixels.emplace_back(u, v);
  }
  cv::undistortPoints(pixels, sources, cameraMatrix(camera), lens, cv::noArray(), cameraMatrix(wide));
  cv::Mat map;
  cv::Mat(sources).reshape(2, camera.height).convertTo(map, CV_32FC2);
  for (cv::Mat* image : {&view.depth_m, &view.cos_incidence})
    cv::remap(*image, *image, map, cv::noArray(), cv::INTER_NEAREST);
  cv::remap(view.color, view.color, map, cv::noArray(), cv::INTER_LINEAR);
  return view;
}

}  // namespace depth_fusion
