// A corridor of 90 m along x that is exactly the same every 3 m.
#include "tools/simulation/floor_plan.h"
#include "tools/simulation/scenes.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

constexpr int kBays = 30;
constexpr double kBay_m = 3.0;
constexpr double kStride_m_s = 0.6;

// One bay: the floor, walls and ceiling from x = 0 to 3, with a door, a picture and a bench.
std::vector<Primitive> bay() {
  const Material paint{{185, 200, 205}, Pattern::kMottle, 0.6, 0.3};
  const Material tiling{{140, 145, 145}, Pattern::kTiles, 0.3, 0.3};
  std::vector<Primitive> solids;
  const auto addBox = [&](const Vector3d& low, const Vector3d& high, const Material& material) {
    Pose T_W_S = Pose::Identity();
    T_W_S.translation() = 0.5 * (low + high);
    solids.emplace_back(Shape::kBox, T_W_S, 0.5 * (high - low), material);
  };
  addBox({0.0, -1.5, -0.25}, {kBay_m, 1.5, 0.0}, tiling);
  addBox({0.0, -1.5, kRoomHeight_m}, {kBay_m, 1.5, kRoomHeight_m + 0.25}, paint);
  addBox({0.0, -1.5, 0.0}, {kBay_m, -1.25, kRoomHeight_m}, paint);
  addBox({0.0, 1.25, 0.0}, {kBay_m, 1.5, kRoomHeight_m}, paint);
  const auto add = [&](const char* kind, double x_m, double y_m, double yaw_deg) {
    Pose T_W_P(Eigen::AngleAxisd(yaw_deg * 3.141592653589793 / 180.0, Vector3d::UnitZ()));
    T_W_P.pretranslate(Vector3d(x_m, y_m, 0.0));
    addPiece(kind, T_W_P, 0, solids);
  };
  add("door", 0.9, 1.25, -90.0);
  add("picture", 2.2, 1.25, -90.0);
  add("bench", 1.6, -1.0, 90.0);
  return solids;
}

Gaze ahead(const Sway& walk, const Sway& look) {
  Gaze gaze;
  gaze.eye_W = {3.0 + kStride_m_s * walk.time_s(), 0.1 * walk(0, 9.0), 1.4 + 0.03 * walk(1, 5.0)};
  gaze.target_W = gaze.eye_W + Vector3d(1.0, 0.25 * look(2, 7.0), -0.12 + 0.05 * look(3, 6.0));
  return gaze;
}

}  // namespace

SimulatedScene makeRepeatedCorridorScene() {
  std::vector<Primitive> solids;
  const std::vector<Primitive> one = bay();
  for (int i = 0; i < kBays; ++i) {
    Pose motion = Pose::Identity();
    motion.translation().x() = i * kBay_m;
    for (const Primitive& solid : one) solids.push_back(solid.moved(motion));
  }
  return {Scene(std::move(solids)), kinectSensor(), ahead};
}

}  // namespace depth_fusion
