#include "surface_mesh/marching_cubes_table.h"

#include <algorithm>
#include <utility>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

// The corners of each face, counter-clockwise seen from outside of the cell.
constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                              {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

constexpr CubeEdge kNone = 255;

CubeEdge edgeBetween(int a, int b) {
  const int axis = (a ^ b) >> 1;  // 1, 2, 4 -> 0, 1, 2
  return static_cast<CubeEdge>(4 * std::min(a, b) + axis);
}

bool isInside(int cube_case, int corner) { return (cube_case >> corner & 1) != 0; }

// Finds, for each edge with a vertex, the next edge of its contour. Around a face, the line goes from the
// edge where inside corners begin to the edge where they end; the next face runs along that edge the other
// way, so that they begin there.
std::array<CubeEdge, 32> contourSuccessors(int cube_case) {
  std::array<CubeEdge, 32> successors;
  successors.fill(kNone);
  for (const auto& face : kFaces) {
    for (int begin = 0; begin < 4; ++begin) {
      if (isInside(cube_case, face[begin]) || !isInside(cube_case, face[(begin + 1) % 4])) continue;
      int end = begin + 1;
      while (isInside(cube_case, face[(end + 1) % 4])) ++end;
      successors[edgeBetween(face[begin], face[(begin + 1) % 4])] =
          edgeBetween(face[end % 4], face[(end + 1) % 4]);
    }
  }
  return successors;
}

int sidesAcrossFaces(const CubeLoop& loop, size_t apex) {
  int count = 0;
  for (size_t i = 2; i + 1 < loop.size(); ++i) {
    count += shareFace(loop[apex], loop[(apex + i) % loop.size()]) ? 1 : 0;
  }
  return count;
}

std::vector<CubeTriangle> fan(const CubeLoop& loop, size_t apex) {
  std::vector<CubeTriangle> triangles;
  for (size_t i = 1; i + 1 < loop.size(); ++i) {
    triangles.push_back({loop[apex], loop[(apex + i) % loop.size()], loop[(apex + i + 1) % loop.size()]});
  }
  return triangles;
}

std::vector<CubeTriangle> triangulate(const CubeLoop& loop) {
  for (size_t apex = 0; apex < loop.size(); ++apex) {
    if (sidesAcrossFaces(loop, apex) == 0) return fan(loop, apex);
  }
  throw Error("marching cubes: a contour has no triangulation within its cell");
}

}  // namespace

bool shareFace(CubeEdge a, CubeEdge b) {
  const int all_set = lowerCorner(a) & upperCorner(a) & lowerCorner(b) & upperCorner(b);
  const int any_set = lowerCorner(a) | upperCorner(a) | lowerCorner(b) | upperCorner(b);
  return all_set != 0 || any_set != 7;
}

std::vector<CubeLoop> contourLoops(int cube_case) {
  std::array<CubeEdge, 32> successors = contourSuccessors(cube_case);
  std::vector<CubeLoop> loops;
  for (size_t first = 0; first < successors.size(); ++first) {
    CubeLoop loop;
    for (auto edge = static_cast<CubeEdge>(first); successors[edge] != kNone;) {
      loop.push_back(edge);
      edge = std::exchange(successors[edge], kNone);
    }
    if (!loop.empty()) loops.push_back(loop);
  }
  return loops;
}

std::vector<CubeTriangle> cubeTriangles(int cube_case) {
  std::vector<CubeTriangle> triangles;
  for (const CubeLoop& loop : contourLoops(cube_case)) {
    for (const CubeTriangle& triangle : triangulate(loop)) triangles.push_back(triangle);
  }
  return triangles;
}

std::vector<uint8_t> marchingCubesTable() {
  std::vector<uint8_t> table(kCubeCases * kCubeCaseBytes, 0);
  for (int cube_case = 0; cube_case < kCubeCases; ++cube_case) {
    uint8_t* entry = table.data() + cube_case * kCubeCaseBytes;
    const std::vector<CubeTriangle> triangles = cubeTriangles(cube_case);
    *entry++ = static_cast<uint8_t>(triangles.size());
    for (const CubeTriangle& triangle : triangles) entry = std::copy(triangle.begin(), triangle.end(), entry);
  }
  return table;
}

}  // namespace depth_fusion
