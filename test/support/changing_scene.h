// Things at 1 to 2 m from a Kinect-like sensor at given poses; what stands there may change from frame to
// frame.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>

#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "depth_fusion/surface_mesh/surface_mesh.h"
#include "tools/evaluation/mesh_error.h"
#include "tools/simulation/camera_path.h"
#include "tools/simulation/sensor_model.h"

namespace depth_fusion {

using Solids = std::vector<Primitive>;

// Makes a floor and a wall, 1.9 m away.
inline Solids corner() { return {plane({0, 0, 0}, {0, 0, 1}, {}), plane({0, 1.9, 0}, {0, -1, 0}, {})}; }

inline Solids tableWithThings() {
  Solids solids = corner();
  solids.push_back(box({0.0, 1.35, 0.6}, {1.0, 0.6, 0.06}, {}));
  for (const double x : {-0.42, 0.42}) solids.push_back(box({x, 1.35, 0.3}, {0.06, 0.5, 0.62}, {}));
  solids.push_back(box({-0.25, 1.4, 0.72}, {0.26, 0.2, 0.2}, {}, 0.4));
  solids.push_back(sphere({0.08, 1.3, 0.73}, 0.11, {}));
  solids.push_back(cylinder({0.33, 1.45, 0.6}, {0.33, 1.45, 0.9}, 0.07, {}));
  return solids;
}

// The camera sways about a point at 1.2 m height and looks at the table's place.
inline Pose swayingPose(int frame) {
  const GazePath path = [](const Sway& walk, const Sway&) {
    return Gaze{{0.35 * walk(0, 3.0), 0.1 * walk(1, 4.0), 1.2 + 0.12 * walk(2, 2.5)},
                {0.05 * walk(3, 2.0), 1.4, 0.75}};
  };
  return handHeldPose(path, 1, {}, frame / 30.0);
}

inline PipelineParameters fineVoxels() {
  PipelineParameters parameters;
  parameters.map.voxel_size_m = 0.004f;
  parameters.texture_odometry.enabled = false;
  return parameters;
}

struct ChangingScene {
  std::function<Solids(int)> solids_at;  // by frame
  std::function<Pose(int)> pose_at = swayingPose;
};

constexpr CameraIntrinsics kFullSize{640, 480, 525.0, 525.0, 319.5, 239.5};

class SceneFusion {
 public:
  SceneFusion(const ChangingScene& scene, const PipelineParameters& parameters,
              const CameraIntrinsics& camera = kFullSize)
      : scene_(scene), camera_(camera), pipeline_(compute_, parameters, camera) {}

  void fuseUntil(int end) {
    for (; frame_ < end; ++frame_) {
      const Pose T_W_D = scene_.pose_at(frame_);
      RgbdFrame frame;
      frame.intrinsics = camera_;
      const RenderedView view = render(Scene(scene_.solids_at(frame_)), camera_, T_W_D);
      frame.depth = senseDepth(view, kinectSensor(), frame_);
      pipeline_.processFrame(frame, T_W_D);
    }
  }

  TriangleMesh mesh() {
    TriangleMesh mesh;
    exportSurfaceMesh(compute_, pipeline_.map(), mesh);
    return mesh;
  }

  // Returns the sizes, in vertices, of the connected parts of what is farther than margin_m from the surface
  // that is left, and was in view for the last 30 frames.
  std::vector<size_t> ghosts(const Solids& left, double margin_m) {
    const TriangleMesh fused = mesh();
    const Scene surface(left);
    std::vector<bool> far;
    for (const MeshVertex& vertex : fused.vertices) {
      const Eigen::Vector3d p_W = vertex.position_W.cast<double>();
      far.push_back(std::abs(surface.distance(p_W)) > margin_m && wasInView(p_W, 30));
    }
    return sizesOfParts(fused, far);
  }

 private:
  bool wasInView(const Eigen::Vector3d& p_W, int last_frames) const {
    for (int i = frame_ - last_frames; i < frame_; ++i) {
      const Eigen::Vector3d p = scene_.pose_at(i).inverse() * p_W;
      const double u = camera_.fx * p.x() / p.z() + camera_.cx;
      const double v = camera_.fy * p.y() / p.z() + camera_.cy;
      if (p.z() <= 0.0 || u < 2.0 || v < 2.0 || u > camera_.width - 3 || v > camera_.height - 3) return false;
    }
    return true;
  }

  // Returns the sizes of the parts of the mesh that the chosen vertices make, the largest first.
  static std::vector<size_t> sizesOfParts(const TriangleMesh& mesh, const std::vector<bool>& chosen) {
    std::vector<size_t> root(mesh.vertices.size());
    std::iota(root.begin(), root.end(), 0);
    const auto find = [&](size_t i) {
      while (root[i] != i) i = root[i] = root[root[i]];
      return i;
    };
    for (const auto& [a, b, c] : mesh.triangles) {
      for (const auto& [i, j] : {std::pair(a, b), std::pair(b, c)}) {
        if (chosen[i] && chosen[j]) root[find(i)] = find(j);
      }
    }
    std::map<size_t, size_t> sizes;
    for (size_t i = 0; i < root.size(); ++i) {
      if (chosen[i]) ++sizes[find(i)];
    }
    std::vector<size_t> result;
    for (const auto& entry : sizes) result.push_back(entry.second);
    std::sort(result.rbegin(), result.rend());
    return result;
  }

  ComputeContext compute_;
  ChangingScene scene_;
  CameraIntrinsics camera_;
  ReconstructionPipeline pipeline_;
  int frame_ = 0;
};

}  // namespace depth_fusion
