#include "tools/simulation/furniture.h"

#include <map>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

struct Part {
  Shape shape;
  Vector3d centre_m, size_m;
  Material material;
};

const Material kOak{{95, 140, 185}, Pattern::kWood, 0.12, 0.35};
const Material kWalnut{{50, 80, 120}, Pattern::kWood, 0.12, 0.45};
const Material kCloth{{120, 90, 60}, Pattern::kTiles, 0.12, 0.6};
const Material kSteel{{150, 150, 145}, Pattern::kSpeckles, 0.08, 0.25};
const Material kBooks{{110, 120, 140}, Pattern::kTiles, 0.07, 0.8};
const Material kPrint{{140, 140, 150}, Pattern::kTiles, 0.1, 0.8};
const Material kLeaves{{70, 150, 70}, Pattern::kSpeckles, 0.06, 0.9};
const Material kEnamel{{215, 220, 220}, Pattern::kPlain};
const Material kScreen{{60, 60, 60}, Pattern::kTiles, 0.12, 0.5};

constexpr Shape kBox = Shape::kBox, kDrum = Shape::kCylinder, kBall = Shape::kSphere;

// What hangs on a wall or stands at one has the wall at x = 0.
const std::map<std::string, std::vector<Part>>& catalogue() {
  static const std::map<std::string, std::vector<Part>> pieces = {
      {"table",
       {{kBox, {0, 0, 0.72}, {0.8, 1.6, 0.05}, kOak},
        {kBox, {0, 0.6, 0.35}, {0.5, 0.08, 0.7}, kWalnut},
        {kBox, {0, -0.6, 0.35}, {0.5, 0.08, 0.7}, kWalnut},
        {kBox, {0.1, 0.2, 0.77}, {0.22, 0.3, 0.06}, kBooks},
        {kDrum, {-0.15, -0.35, 0.83}, {0.12, 0.12, 0.2}, kPrint}}},
      {"desk",
       {{kBox, {0.35, 0, 0.72}, {0.7, 1.4, 0.04}, kOak},
        {kBox, {0.35, 0.55, 0.35}, {0.6, 0.25, 0.7}, kSteel},
        {kBox, {0.35, -0.67, 0.35}, {0.6, 0.06, 0.7}, kOak},
        {kBox, {0.2, 0.1, 1.0}, {0.06, 0.55, 0.34}, kScreen},
        {kBox, {0.22, 0.1, 0.77}, {0.16, 0.2, 0.1}, kSteel},
        {kBox, {0.5, -0.4, 0.79}, {0.3, 0.22, 0.12}, kBooks}}},
      {"chair",
       {{kBox, {0, 0, 0.44}, {0.42, 0.42, 0.07}, kCloth},
        {kBox, {-0.19, 0, 0.68}, {0.06, 0.4, 0.46}, kCloth},
        {kBox, {0, 0, 0.22}, {0.08, 0.08, 0.4}, kSteel},
        {kBox, {0, 0, 0.03}, {0.4, 0.4, 0.06}, kSteel}}},
      {"shelf",
       {{kBox, {0.02, 0, 0.95}, {0.04, 1.2, 1.9}, kWalnut},
        {kBox, {0.18, 0.58, 0.95}, {0.34, 0.04, 1.9}, kWalnut},
        {kBox, {0.18, -0.58, 0.95}, {0.34, 0.04, 1.9}, kWalnut},
        {kBox, {0.18, 0, 0.1}, {0.34, 1.2, 0.04}, kWalnut},
        {kBox, {0.18, 0, 0.7}, {0.34, 1.2, 0.04}, kWalnut},
        {kBox, {0.18, 0, 1.3}, {0.34, 1.2, 0.04}, kWalnut},
        {kBox, {0.15, -0.25, 0.27}, {0.22, 0.5, 0.3}, kBooks},
        {kBox, {0.17, 0.2, 0.85}, {0.24, 0.6, 0.26}, kBooks},
        {kBox, {0.14, -0.3, 1.44}, {0.2, 0.4, 0.24}, kBooks}}},
      {"cabinet",
       {{kBox, {0.25, 0, 0.5}, {0.5, 1.0, 1.0}, kSteel},
        {kBox, {0.51, 0, 0.75}, {0.03, 0.9, 0.04}, kEnamel},
        {kBox, {0.51, 0, 0.35}, {0.03, 0.9, 0.04}, kEnamel},
        {kBox, {0.25, 0.2, 1.12}, {0.3, 0.35, 0.26}, kPrint}}},
      {"locker", {{kBox, {0.25, 0, 0.95}, {0.5, 0.6, 1.9}, kSteel}}},
      {"sofa",
       {{kBox, {0.45, 0, 0.2}, {0.8, 1.8, 0.42}, kCloth},
        {kBox, {0.15, 0, 0.5}, {0.24, 1.8, 0.6}, kCloth},
        {kBox, {0.45, 0.85, 0.32}, {0.8, 0.2, 0.62}, kCloth},
        {kBox, {0.45, -0.85, 0.32}, {0.8, 0.2, 0.62}, kCloth}}},
      {"bench",
       {{kBox, {0.2, 0, 0.44}, {0.36, 1.4, 0.06}, kOak},
        {kBox, {0.2, 0.55, 0.21}, {0.3, 0.06, 0.42}, kSteel},
        {kBox, {0.2, -0.55, 0.21}, {0.3, 0.06, 0.42}, kSteel}}},
      {"plant",
       {{kDrum, {0.2, 0, 0.2}, {0.32, 0.32, 0.4}, kPrint},
        {kBall, {0.2, 0, 0.75}, {0.6, 0.6, 0.6}, kLeaves}}},
      {"bin", {{kDrum, {0.18, 0, 0.3}, {0.3, 0.3, 0.6}, kSteel}}},
      {"crate",
       {{kBox, {0.25, 0, 0.2}, {0.4, 0.5, 0.4}, kOak}, {kBox, {0.2, 0.04, 0.55}, {0.3, 0.36, 0.3}, kPrint}}},
      {"picture", {{kBox, {0.02, 0, 1.55}, {0.05, 0.9, 0.65}, kPrint}}},
      {"notice",
       {{kBox, {0.015, 0, 1.5}, {0.04, 0.5, 0.7}, kPrint},
        {kBox, {0.015, 0.6, 1.6}, {0.04, 0.3, 0.42}, kBooks}}},
      {"board",
       {{kBox, {0.02, 0, 1.5}, {0.05, 2.4, 1.2}, kEnamel}, {kBox, {0.06, 0, 0.9}, {0.1, 2.0, 0.03}, kSteel}}},
      {"radiator", {{kBox, {0.08, 0, 0.45}, {0.12, 1.2, 0.6}, kEnamel}}},
      {"hydrant", {{kBox, {0.1, 0, 1.1}, {0.2, 0.5, 0.7}, {{60, 60, 200}, Pattern::kTiles, 0.12, 0.5}}}},
      {"pillar", {{kBox, {0.08, 0, 1.3}, {0.18, 0.4, 2.6}, kSteel}}},
      {"beam", {{kBox, {0, 0, 2.5}, {0.2, 2.4, 0.24}, kOak}}},
      {"lamp", {{kBox, {0, 0, 2.52}, {0.3, 1.2, 0.1}, kEnamel}}},
      {"sign", {{kBox, {0, 0, 2.35}, {0.05, 0.7, 0.3}, kPrint}}},
      {"door",
       {{kBox, {0.01, 0, 1.03}, {0.04, 0.94, 2.06}, kOak},
        {kBox, {0.02, 0.53, 1.06}, {0.08, 0.1, 2.14}, kSteel},
        {kBox, {0.02, -0.53, 1.06}, {0.08, 0.1, 2.14}, kSteel},
        {kBox, {0.02, 0, 2.12}, {0.08, 1.16, 0.1}, kSteel},
        {kBox, {0.05, -0.36, 1.05}, {0.08, 0.14, 0.03}, kSteel},
        {kBox, {0.02, 0.75, 1.6}, {0.03, 0.16, 0.2}, kPrint}}},
      {"rug", {{kBox, {0, 0, 0.01}, {2.0, 3.0, 0.04}, {{80, 80, 150}, Pattern::kTiles, 0.18, 0.7}}}},
  };
  return pieces;
}

// Makes every copy of a piece a little bluer, greener or redder.
Material tinted(Material material, int variant) {
  if (material.pattern == Pattern::kPlain) return material;
  for (int channel = 0; channel < 3; ++channel) {
    material.color_bgr[channel] *= 0.8 + 0.1 * ((variant * 7 + channel * 3 * variant) % 5);
  }
  return material;
}

}  // namespace

void addPiece(const std::string& kind, const Pose& T_R_P, int variant, std::vector<Primitive>& solids) {
  const auto piece = catalogue().find(kind);
  check(piece != catalogue().end(), "there is no furniture '" + kind + "'");
  for (const Part& part : piece->second) {
    Pose T_P_S = Pose::Identity();
    T_P_S.translation() = part.centre_m;
    solids.emplace_back(part.shape, T_R_P * T_P_S, part.size_m / 2.0, tinted(part.material, variant));
  }
}

}  // namespace depth_fusion
