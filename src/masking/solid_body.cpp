#include "depth_fusion/masking/solid_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>

#include "depth_fusion/common/error.h"
#include "masking/depth_pixels.h"

namespace depth_fusion {
namespace {

// The numbers of a kind behind its middle.
const std::map<std::string, size_t> kSizes = {{"box", 3}, {"sphere", 1}, {"cylinder", 2}};

BodyPart parsePart(const std::string& text) {
  std::istringstream words(text);
  BodyPart part;
  std::string kind, rest;
  words >> part.frame >> kind;
  const auto known = kSizes.find(kind);
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  std::array<double, 3> size = {1.0, 1.0, 1.0};
  words >> middle.x() >> middle.y() >> middle.z();
  for (size_t i = 0; known != kSizes.end() && i < known->second; ++i) words >> size[i];
  const bool is_whole =
      known != kSizes.end() && !words.fail() && !(words >> rest) && middle.allFinite() &&
      std::all_of(size.begin(), size.end(), [](double s) { return std::isfinite(s) && s > 0.0; });
  check(is_whole, "masking/body: '" + text +
                      "' is no solid; give FRAME box X Y Z LENGTH WIDTH HEIGHT, FRAME sphere X Y Z RADIUS or "
                      "FRAME cylinder X Y Z RADIUS LENGTH, in metres");
  part.T_F_S.translation() = middle;
  part.solid = kind == "box"      ? Solid::box({size[0], size[1], size[2]})
               : kind == "sphere" ? Solid::sphere(size[0])
                                  : Solid::cylinder(size[0], size[1]);
  return part;
}

// The pixels that a ball about the point c can cover along one axis: all of them if it reaches the camera.
cv::Range pixelsOf(double c, double z, double radius, double focal, double principal, int pixels) {
  const double nearest = z - radius, farthest = z + radius;
  if (nearest <= 0.0) return {0, farthest <= 0.0 ? 0 : pixels};
  const auto along = [&](double edge, bool is_low) {
    return focal * edge / ((edge < 0.0) == is_low ? nearest : farthest) + principal;
  };
  const double last = pixels;
  const double begin = std::clamp(std::floor(along(c - radius, true)), 0.0, last);
  const double end = std::clamp(std::ceil(along(c + radius, false)) + 1.0, 0.0, last);
  return {static_cast<int>(begin), static_cast<int>(std::max(begin, end))};
}

size_t cutOutOne(RgbdFrame& frame, const PlacedSolid& placed, double padding_m) {
  const CameraIntrinsics& camera = frame.intrinsics;
  const Pose T_S_D = placed.T_D_S.inverse();
  const Eigen::Vector3d middle_D = placed.T_D_S.translation();
  const double radius_m = placed.solid.radius_m() + std::sqrt(3.0) * padding_m;  // of a box with padding, too
  const cv::Range columns =
      pixelsOf(middle_D.x(), middle_D.z(), radius_m, camera.fx, camera.cx, frame.depth.cols);
  const cv::Range rows =
      pixelsOf(middle_D.y(), middle_D.z(), radius_m, camera.fy, camera.cy, frame.depth.rows);
  size_t cut = 0;
  for (int y = rows.start; y < rows.end; ++y) {
    for (int x = columns.start; x < columns.end; ++x) {
      const double z = depthAt_m(frame, x, y);
      if (!(z > middle_D.z() - radius_m && z < middle_D.z() + radius_m && z > 0.0)) continue;
      if (!placed.solid.contains(T_S_D * pointAt(camera, x, y, z), padding_m)) continue;
      clearDepth(frame.depth, x, y);
      ++cut;
    }
  }
  return cut;
}

}  // namespace

bool Solid::contains(const Eigen::Vector3d& p_S, double padding_m) const {
  const Eigen::Array3d reach = half_m.array() + padding_m;
  switch (kind) {
    case Kind::kBox:
      return (p_S.array().abs() <= reach).all();
    case Kind::kSphere:
      return p_S.norm() <= reach.x();
    case Kind::kCylinder:
      return p_S.head<2>().norm() <= reach.x() && std::abs(p_S.z()) <= reach.z();
  }
  return false;
}

double Solid::radius_m() const {
  switch (kind) {
    case Kind::kBox:
      return half_m.norm();
    case Kind::kSphere:
      return half_m.x();
    case Kind::kCylinder:
      return std::hypot(half_m.x(), half_m.z());
  }
  return 0.0;
}

std::vector<BodyPart> parseBody(const std::string& text) {
  std::vector<BodyPart> parts;
  std::istringstream list(text);
  std::string part;
  while (std::getline(list, part, ';')) {
    if (part.find_first_not_of(" \t\n") != std::string::npos) parts.push_back(parsePart(part));
  }
  return parts;
}

size_t cutOut(RgbdFrame& frame, const std::vector<PlacedSolid>& solids, double padding_m) {
  frame.depth = frame.depth.clone();
  size_t cut = 0;
  for (const PlacedSolid& placed : solids) cut += cutOutOne(frame, placed, padding_m);
  return cut;
}

}  // namespace depth_fusion
