// A scene whose colours are known at every point of its surface, and what fusion makes of it.
#pragma once

#include <functional>

#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "depth_fusion/surface_mesh/surface_mesh.h"
#include "depth_fusion/surface_mesh/triangle_mesh.h"
#include "support/simulated_frames.h"
#include "support/test_compute.h"
#include "tools/simulation/renderer.h"

namespace depth_fusion {

constexpr CameraIntrinsics kColorTestCamera{320, 240, 262.5, 262.5, 159.5, 119.5};

inline Material paint(const Eigen::Vector3d& color_bgr, double scale_m) {
  return {color_bgr, Pattern::kSpeckles, scale_m, 0.3, false};
}

// Makes a wall, and a box before it of another colour; neither depends on where the camera is.
inline const Scene& coloredScene() {
  static const Scene scene(
      {plane({0.0, 0.0, 1.6}, {0.0, 0.0, -1.0}, paint({150.0, 110.0, 70.0}, 0.2)),
       box({0.12, 0.08, 1.25}, {0.36, 0.3, 0.2}, paint({60.0, 90.0, 170.0}, 0.15), 0.3)});
  return scene;
}

// The camera stands at the origin, sways a little and looks along z.
inline Pose swayingPose(int frame) {
  return motionOf({3.0 * std::sin(0.9 * frame), 5.0 * std::sin(0.7 * frame), 4.0 * std::sin(0.5 * frame)},
                  {0.12 * std::sin(0.8 * frame), 0.1 * std::sin(1.1 * frame), 0.05 * std::sin(0.6 * frame)});
}

// Renders exact depth and colour from a pose, the colour through a camera of its own if it is given.
inline RgbdFrame exactFrame(const Scene& scene, const Pose& T_W_D) {
  const RenderedView view = render(scene, kColorTestCamera, T_W_D);
  RgbdFrame frame;
  frame.depth = view.depth_m;
  frame.color = view.color;
  frame.intrinsics = kColorTestCamera;
  return frame;
}

inline PipelineParameters colorParameters() {
  PipelineParameters parameters;
  parameters.map.voxel_size_m = 0.01f;
  parameters.map.blocks_per_axis = 64;
  parameters.map.pool_mib = 32;
  parameters.map.color = true;
  return parameters;
}

// May spoil the frame of a number before fuseFrames() fuses it; the frames are seen from given poses.
using FrameChange = std::function<void(int, RgbdFrame&)>;

inline TriangleMesh fuseFrames(const PipelineParameters& parameters, int frames,
                               const FrameChange& change = {},
                               const std::function<Pose(int)>& poseOf = swayingPose) {
  ReconstructionPipeline pipeline(compute(), parameters, kColorTestCamera);
  for (int i = 0; i < frames; ++i) {
    RgbdFrame frame = exactFrame(coloredScene(), poseOf(i));
    if (change) change(i, frame);
    pipeline.processFrame(frame, poseOf(i));
  }
  TriangleMesh mesh;
  exportSurfaceMesh(compute(), pipeline.map(), mesh);
  return mesh;
}

inline cv::Mat scaledColor(const cv::Mat& color, const cv::Scalar& gains) {
  cv::Mat result;
  cv::multiply(color, gains, result);
  return result;
}

// Holds how far the vertices' colours are from the scene's, channel by channel, in steps of 255.
struct ColorErrors {
  std::vector<double> all;          // away from where the box meets the wall
  std::vector<double> left, right;  // of those, by the sign of x
  size_t unknown = 0;               // grey vertices

  static double mean(const std::vector<double>& errors) { return errors.empty() ? 1e9 : cv::mean(errors)[0]; }
};

inline ColorErrors colorErrors(const TriangleMesh& mesh, const Scene& scene) {
  constexpr double kBorder_m = 0.03;
  ColorErrors errors;
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d p_W = mesh.vertices[i].position_W.cast<double>();
    const bool is_unknown = mesh.colors[i] == MeshColor{128, 128, 128};
    if (is_unknown) ++errors.unknown;
    int near = 0;
    const Primitive* nearest = nullptr;
    for (const Primitive& primitive : scene.primitives()) {
      const double distance_m = std::abs(primitive.distance(p_W));
      near += distance_m < kBorder_m;
      if (nearest == nullptr || distance_m < std::abs(nearest->distance(p_W))) nearest = &primitive;
    }
    if (near != 1 || is_unknown) continue;
    const Eigen::Vector3d truth_bgr = textureColor(nearest->material(), p_W);
    double error = 0.0;
    for (int channel = 0; channel < 3; ++channel) {
      error += std::abs(mesh.colors[i][channel] - truth_bgr[2 - channel]) / 3.0;
    }
    errors.all.push_back(error);
    (p_W.x() < 0.0 ? errors.left : errors.right).push_back(error);
  }
  return errors;
}

}  // namespace depth_fusion
