#include "tools/simulation/floor_plan.h"

#include <algorithm>
#include <cmath>

#include "depth_fusion/geometry/angles.h"

namespace depth_fusion {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kHalfTurn_rad = 3.141592653589793;
constexpr double kHalfWall_m = 0.1;
constexpr double kSlab_m = 0.2;
constexpr double kFrame_m = 0.08;
constexpr double kFrameDepth_m = 0.03;
const Material kFramePaint{{130, 130, 125}, Pattern::kSpeckles, 0.1, 0.3};

// A value in [-1, 1] that depends on both numbers.
double jitter(int seed, int index) { return (73 * seed + 151 * index + 37 * seed * index) % 17 / 8.0 - 1.0; }

// A part of a wall, `from_m` to `to_m` along it.
struct Gap {
  double from_m, to_m, height_m;
};

// Builds a room about the origin and moves it to its place.
class RoomBuilder {
 public:
  RoomBuilder(const RoomPlan& plan, const std::vector<Doorway>& doorways)
      : plan_(plan), doorways_(doorways), centre_m_(plan.ground.centre_m()) {
    const GroundPlan& ground = plan.ground;
    half_m_ = Vector2d(ground.x1_m - ground.x0_m, ground.y1_m - ground.y0_m) / 2.0;
  }

  std::vector<Primitive> build() {
    addSlab(-kSlab_m / 2.0, plan_.finish.floor);
    addSlab(kRoomHeight_m + kSlab_m / 2.0, plan_.finish.ceiling);
    for (int side = 0; side < 4; ++side) addWall(side);
    for (const Piece& piece : plan_.furniture) add(piece);
    Pose T_L_W = Pose::Identity();
    T_L_W.translation().head<2>() = -plan_.look_moved_by_m;
    for (Primitive& solid : solids_) {
      solid.moveOnGrid({centre_m_.x(), centre_m_.y(), 0.0});
      solid.setLook(T_L_W);
    }
    return solids_;
  }

 private:
  void addBox(const Vector3d& low_m, const Vector3d& high_m, const Material& material) {
    solids_.push_back(box((low_m + high_m) / 2.0, high_m - low_m, material));
  }

  void addSlab(double z_m, const Material& material) {
    addBox({-half_m_.x(), -half_m_.y(), z_m - kSlab_m / 2.0}, {half_m_.x(), half_m_.y(), z_m + kSlab_m / 2.0},
           material);
  }

  // Sides 0 and 1 are those at low and high y, along x; 2 and 3 those at low and high x, along y.
  void addWall(int side) {
    double from_m = -half_m_[side / 2];
    for (const Gap& gap : gapsIn(side)) {
      addWallPart(side, from_m, gap.from_m, 0.0, kRoomHeight_m, 0.0, plan_.finish.wall);
      addFrame(side, gap);
      from_m = gap.to_m;
    }
    addWallPart(side, from_m, half_m_[side / 2], 0.0, kRoomHeight_m, 0.0, plan_.finish.wall);
  }

  void addFrame(int side, const Gap& gap) {
    if (gap.height_m >= kRoomHeight_m) return;
    const double above_m = gap.height_m + kFrame_m;
    addWallPart(side, gap.from_m, gap.to_m, gap.height_m, kRoomHeight_m, 0.0, plan_.finish.wall);
    addWallPart(side, gap.from_m - kFrame_m, gap.to_m + kFrame_m, gap.height_m, above_m, kFrameDepth_m,
                kFramePaint);
    addWallPart(side, gap.from_m - kFrame_m, gap.from_m, 0.0, gap.height_m, kFrameDepth_m, kFramePaint);
    addWallPart(side, gap.to_m, gap.to_m + kFrame_m, 0.0, gap.height_m, kFrameDepth_m, kFramePaint);
  }

  // Adds a part of the wall, thicker by `out_m` towards the room.
  void addWallPart(int side, double from_m, double to_m, double bottom_m, double top_m, double out_m,
                   const Material& material) {
    if (to_m <= from_m) return;
    const int along = side / 2, across = 1 - along;
    const double edge_m = half_m_[across], inner_m = edge_m - kHalfWall_m - out_m;
    Vector3d low, high;
    low[along] = from_m;
    high[along] = to_m;
    low[across] = side % 2 == 0 ? -edge_m : inner_m;
    high[across] = side % 2 == 0 ? -inner_m : edge_m;
    low.z() = bottom_m;
    high.z() = top_m;
    addBox(low, high, material);
  }

  std::vector<Gap> gapsIn(int side) const {
    const int along = side / 2, across = 1 - along;
    const double edge_m = side % 2 == 0 ? -half_m_[across] : half_m_[across];
    std::vector<Gap> gaps;
    for (const Doorway& doorway : doorways_) {
      const Vector2d at_m = Vector2d(doorway.x_m, doorway.y_m) - centre_m_;
      if (at_m[across] != edge_m || std::abs(at_m[along]) >= half_m_[along]) continue;
      const double half_width_m = doorway.width_m / 2.0;
      gaps.push_back({at_m[along] - half_width_m, at_m[along] + half_width_m, doorway.height_m});
    }
    std::sort(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) { return a.from_m < b.from_m; });
    return gaps;
  }

  void add(const Piece& piece) {
    constexpr double kJitter_m = 0.12;
    for (int i = 0; i < piece.count; ++i) {
      const int index = pieces_++;
      const Vector3d at(piece.x_m + i * piece.step_x_m, piece.y_m + i * piece.step_y_m, piece.z_m);
      Pose T_R_P(Eigen::AngleAxisd(plan_.turned ? kHalfTurn_rad : 0.0, Vector3d::UnitZ()));
      T_R_P.translate(at).rotate(Eigen::AngleAxisd(piece.yaw_deg * kRadPerDeg, Vector3d::UnitZ()));
      T_R_P.translate(Vector3d(0.0, kJitter_m * jitter(plan_.seed, index), 0.0));
      addPiece(piece.kind, T_R_P, plan_.seed + index, solids_);
    }
  }

  const RoomPlan& plan_;
  const std::vector<Doorway>& doorways_;
  std::vector<Primitive> solids_;
  Vector2d centre_m_, half_m_;
  int pieces_ = 0;
};

}  // namespace

std::vector<Primitive> build(const std::vector<RoomPlan>& rooms, const std::vector<Doorway>& doorways) {
  std::vector<Primitive> solids;
  for (const RoomPlan& room : rooms) {
    for (const Primitive& solid : RoomBuilder(room, doorways).build()) solids.push_back(solid);
  }
  return solids;
}

}  // namespace depth_fusion
