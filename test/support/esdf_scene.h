// A scene that is fused frame by frame at exact poses, with the distance field that follows.
#pragma once

#include <numeric>

#include "depth_fusion/esdf/esdf.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"
#include "depth_fusion/tsdf_fusion/tsdf_fusion.h"
#include "support/test_compute.h"
#include "tools/simulation/renderer.h"
#include "tools/simulation/sensor_model.h"

namespace depth_fusion {

constexpr double kRoomVolume_m3 = 3.24 * 2.84 * 2.2;

// A room with a ball and a block that hang in it, so that all of their surface can be seen. Its walls do not
// lie between cells.
inline std::vector<Primitive> closedRoom() {
  return {room({0.0, 0.0, 1.1}, {3.24, 2.84, 2.2}, {}), sphere({1.0, 0.9, 1.3}, 0.25, {}),
          box({-1.1, -0.2, 0.9}, {0.3, 0.5, 0.4}, {}, 0.4)};
}

inline Pose poseLookingAt(const Eigen::Vector3d& eye_W, const Eigen::Vector3d& target_W) {
  Pose T_W_D = Pose::Identity();
  const Eigen::Vector3d z = (target_W - eye_W).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  T_W_D.linear() << x, z.cross(x), z;
  T_W_D.translation() = eye_W;
  return T_W_D;
}

// The camera goes about the room's middle, and looks in all directions.
inline Pose poseLookingAround(int frame, int frames) {
  const double part = 2.0 * M_PI * frame / frames;
  const double yaw = 5.0 * part, pitch = 1.1 * std::sin(13.0 * part);
  const Eigen::Vector3d eye(0.6 * std::cos(part), 0.6 * std::sin(part), 1.1 + 0.5 * std::sin(2.0 * part));
  return poseLookingAt(eye, eye + Eigen::Vector3d(std::cos(yaw) * std::cos(pitch),
                                                  std::sin(yaw) * std::cos(pitch), std::sin(pitch)));
}

constexpr CameraIntrinsics kWideCamera{320, 240, 190.0, 190.0, 159.5, 119.5};

// What a Kinect sees of a scene.
inline RgbdFrame frameOfScene(const Scene& scene, const Pose& T_W_D, int number) {
  RgbdFrame frame;
  frame.intrinsics = kWideCamera;
  frame.depth = senseDepth(render(scene, kWideCamera, T_W_D), kinectSensor(), static_cast<uint64_t>(number));
  return frame;
}

inline PreprocessingParameters nearRange() {
  PreprocessingParameters parameters;
  parameters.min_range_m = 0.1f;
  return parameters;
}

inline MapParameters esdfSceneMap() {
  MapParameters map;
  map.voxel_size_m = 0.01f;
  map.truncation_m = 0.04f;
  map.pool_mib = 128;
  return map;
}

class EsdfScene {
 public:
  EsdfScene(std::vector<Primitive> solids, float cell_m, int memory_mib = 256)
      : scene_(std::move(solids)),
        map_(compute(), esdfSceneMap()),
        preprocessor_(compute(), nearRange(), kWideCamera),
        fusion_(compute(), map_, {}),
        esdf_(compute(), map_, parameters(cell_m, memory_mib)) {}

  const Scene& scene() const { return scene_; }
  BlockMap& map() { return map_; }
  Esdf& esdf() { return esdf_; }
  void show(std::vector<Primitive> solids) { scene_ = Scene(std::move(solids)); }

  // Every frame is seen, and after each the distances are computed.
  void fuse(const Pose& T_W_D) {
    const DepthFrame& depth = preprocessor_.process(frameOfScene(scene_, T_W_D, number_++));
    const FusionResult result = fusion_.integrate(depth, T_W_D, timers_);
    map_.noteUpdated(fusion_.visibleBlocks().read<int>(result.blocks_updated));
    esdf_.readMap(timers_);
    esdf_.see(depth, T_W_D, timers_);
    esdf_.update(timers_);
  }

  void lookAround(int frames) {
    for (int i = 0; i < frames; ++i) fuse(poseLookingAround(i, frames));
  }

 private:
  static EsdfParameters parameters(float cell_m, int memory_mib) {
    EsdfParameters parameters;
    parameters.voxel_size_m = cell_m;
    parameters.memory_mib = memory_mib;
    return parameters;
  }

  Scene scene_;
  BlockMap map_;
  DepthPreprocessor preprocessor_;
  TsdfFusion fusion_;
  Esdf esdf_;
  StageTimers timers_;
  int number_ = 0;
};

}  // namespace depth_fusion
