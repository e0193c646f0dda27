// Furniture as data: pieces made of boxes, upright cylinders and spheres.
#pragma once

#include <string>
#include <vector>

#include "tools/simulation/primitive.h"

namespace depth_fusion {

// A piece that stands in a room. It is made for x forward and z up, at the height z_m.
struct Piece {
  std::string kind;  // one of the catalogue
  double x_m, y_m, yaw_deg;
  double z_m = 0.0;
  // It is repeated so many times, each by that much further.
  int count = 1;
  double step_x_m = 0.0, step_y_m = 0.0;
};

// Adds a piece's solids, which stand in a room R. Another variant has other colours. Throws Error for a kind
// that the catalogue lacks.
void addPiece(const std::string& kind, const Pose& T_R_P, int variant, std::vector<Primitive>& solids);

}  // namespace depth_fusion
