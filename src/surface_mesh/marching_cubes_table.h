// The triangles of marching cubes, derived from topology, so that cells which share a face always agree on
// it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace depth_fusion {

// Corner c of a cell lies at (c & 1, c >> 1 & 1, c >> 2 & 1). A cube case has bit c set where corner c is
// inside (behind the surface). An edge is 4 * (its lower corner) + its axis.
using CubeEdge = uint8_t;
using CubeLoop = std::vector<CubeEdge>;
using CubeTriangle = std::array<CubeEdge, 3>;

constexpr int kCubeCases = 256;
constexpr int kMaxCubeTriangles = 5;
constexpr int kCubeCaseBytes = 16;

inline int lowerCorner(CubeEdge edge) { return edge >> 2; }
inline int upperCorner(CubeEdge edge) { return edge >> 2 | 1 << (edge & 3); }

// Tells whether two edges lie on a common face.
bool shareFace(CubeEdge a, CubeEdge b);

// Returns the closed lines in which the surface cuts the faces of a cell, counter-clockwise as seen from
// outside of the surface. On a face with inside corners at both ends of a diagonal, each of them is cut off
// by itself.
std::vector<CubeLoop> contourLoops(int cube_case);

// Splits the loops into triangles. No triangle has a side across a face, for a neighbouring cell might have
// the same side.
std::vector<CubeTriangle> cubeTriangles(int cube_case);

// Returns the table that the kernels read: kCubeCaseBytes a case, of which the first is the number of
// triangles and the others are three edges each.
std::vector<uint8_t> marchingCubesTable();

}  // namespace depth_fusion
