// Which faces share an edge.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

constexpr uint32_t kNoFace = 0xFFFFFFFF;

// The face beyond each edge, which goes from the corner of that number to the next.
using FaceNeighbours = std::vector<std::array<uint32_t, 3>>;

// An edge of more than two faces has none beyond it.
FaceNeighbours neighboursOf(const std::vector<MeshTriangle>& triangles);

}  // namespace depth_fusion
