// Walks through buildings.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/simulation/camera_path.h"

namespace depth_fusion {

// A closed way on the ground: straight lines whose corners are rounded. It begins at its first corner, which
// must lie on a straight line.
class Route {
 public:
  explicit Route(const std::vector<Eigen::Vector2d>& corners_m);

  double length_m() const { return length_m_; }
  // The point so far along the way, which goes round and round.
  Eigen::Vector2d at(double along_m) const;

 private:
  // An arc; a straight line where curvature_1_m is 0.
  struct Leg {
    Eigen::Vector2d begin_m, direction;
    double curvature_1_m, length_m;
  };
  void addStraight(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m);

  std::vector<Leg> legs_;
  double length_m_ = 0.0;
};

// One of the ways through a scene.
struct Walk {
  std::string name, help;
  GazePath path;
  double round_s = 0.0;    // after so long the camera is back at the start
  bool is_driven = false;  // a robot's wheels carry the camera, without a tremor
};

// Carries the camera along a route at 0.6 m/s and 1.4 m above the ground, looking ahead and a little down.
Walk walkAlong(const std::string& name, const std::string& help,
               const std::vector<Eigen::Vector2d>& corners_m);
// The same of a robot, whose camera looks ahead and down, a metre above the ground.
Walk driveAlong(const std::string& name, const std::string& help,
                const std::vector<Eigen::Vector2d>& corners_m);
// Where that camera stands on the robot, whose origin is on the ground.
Pose cameraOnRobot();

}  // namespace depth_fusion
