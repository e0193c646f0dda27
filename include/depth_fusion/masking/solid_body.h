// Solids that are cut out of depth: a robot does not map itself.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "depth_fusion/frames/rgbd_frame.h"
#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// Its middle is the origin of its frame S; a cylinder's axis is z.
struct Solid {
  enum class Kind { kBox, kSphere, kCylinder };

  Kind kind = Kind::kBox;
  Eigen::Vector3d half_m = Eigen::Vector3d::Zero();  // half the extent along each axis

  static Solid box(const Eigen::Vector3d& edges_m) { return {Kind::kBox, 0.5 * edges_m}; }
  static Solid sphere(double radius_m) { return {Kind::kSphere, Eigen::Vector3d::Constant(radius_m)}; }
  static Solid cylinder(double radius_m, double length_m) {
    return {Kind::kCylinder, {radius_m, radius_m, 0.5 * length_m}};
  }

  // Whether the point is in the solid, or nearer than about padding_m to it.
  bool contains(const Eigen::Vector3d& p_S, double padding_m) const;
  // The sphere about its middle that has all of it is so large.
  double radius_m() const;
};

// A solid that goes with a frame F of the robot.
struct BodyPart {
  std::string frame;
  Pose T_F_S = Pose::Identity();
  Solid solid;
};

// Reads parts of the form that the parameter `body` has. Throws Error that names the part that is none.
std::vector<BodyPart> parseBody(const std::string& text);

struct PlacedSolid {
  Pose T_D_S = Pose::Identity();
  Solid solid;
};

// Takes the depth of pixels away whose points lie in a solid; the frame's depth is then memory of its own.
// Returns their number. The depth has no lens distortion.
size_t cutOut(RgbdFrame& frame, const std::vector<PlacedSolid>& solids, double padding_m);

}  // namespace depth_fusion
