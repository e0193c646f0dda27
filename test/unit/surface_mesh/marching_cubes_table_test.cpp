#include "surface_mesh/marching_cubes_table.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>
#include <set>

namespace depth_fusion {
namespace {

using DirectedSide = std::pair<int, int>;

bool isInside(int cube_case, int corner) { return (cube_case >> corner & 1) != 0; }

Eigen::Vector3d cornerPoint(int corner) {
  return Eigen::Vector3i(corner & 1, corner >> 1 & 1, corner >> 2 & 1).cast<double>();
}

Eigen::Vector3d midpoint(CubeEdge edge) {
  return 0.5 * (cornerPoint(lowerCorner(edge)) + cornerPoint(upperCorner(edge)));
}

std::set<CubeEdge> crossedEdges(int cube_case) {
  std::set<CubeEdge> edges;
  for (int corner = 0; corner < 8; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      if ((corner >> axis & 1) != 0) continue;
      const auto edge = static_cast<CubeEdge>(4 * corner + axis);
      if (isInside(cube_case, lowerCorner(edge)) != isInside(cube_case, upperCorner(edge)))
        edges.insert(edge);
    }
  }
  return edges;
}

// Sides of triangles that no other triangle of the case has in the opposite direction.
std::set<DirectedSide> boundarySides(int cube_case) {
  std::set<DirectedSide> sides;
  for (const CubeTriangle& triangle : cubeTriangles(cube_case)) {
    for (int i = 0; i < 3; ++i) {
      const DirectedSide side(triangle[i], triangle[(i + 1) % 3]);
      if (sides.erase({side.second, side.first}) == 0) sides.insert(side);
    }
  }
  return sides;
}

bool onFace(CubeEdge edge, int axis, int side) {
  return (lowerCorner(edge) >> axis & 1) == side && (upperCorner(edge) >> axis & 1) == side;
}

// Boundary sides on the face `axis` = 1, or = 0 with edges moved to where the cell before has them.
std::set<DirectedSide> sidesOnFace(int cube_case, int axis, int face_side) {
  const auto moved = [&](int edge) { return face_side == 1 ? edge : edge + (4 << axis); };
  std::set<DirectedSide> sides;
  for (const DirectedSide& side : boundarySides(cube_case)) {
    if (onFace(static_cast<CubeEdge>(side.first), axis, face_side) &&
        onFace(static_cast<CubeEdge>(side.second), axis, face_side)) {
      sides.insert({moved(side.first), moved(side.second)});
    }
  }
  return sides;
}

// The inside corners of a face, as corners of the face at 0.
int faceSigns(int cube_case, int axis, int face_side) {
  int signs = 0;
  for (int corner = 0; corner < 8; ++corner) {
    if ((corner >> axis & 1) == face_side && isInside(cube_case, corner))
      signs |= 1 << (corner & ~(1 << axis));
  }
  return signs;
}

TEST(MarchingCubesTable, loopsPassEachCrossedEdgeOnceAndStayOnFaces) {
  for (int cube_case = 0; cube_case < kCubeCases; ++cube_case) {
    std::multiset<CubeEdge> passed;
    for (const CubeLoop& loop : contourLoops(cube_case)) {
      ASSERT_GE(loop.size(), 3u) << "case " << cube_case;
      for (size_t i = 0; i < loop.size(); ++i) {
        passed.insert(loop[i]);
        EXPECT_TRUE(shareFace(loop[i], loop[(i + 1) % loop.size()])) << "case " << cube_case;
      }
    }
    const std::set<CubeEdge> crossed = crossedEdges(cube_case);
    EXPECT_EQ(passed, std::multiset<CubeEdge>(crossed.begin(), crossed.end())) << "case " << cube_case;
  }
}

TEST(MarchingCubesTable, trianglesCoverTheLoopsWithoutSidesAcrossFaces) {
  for (int cube_case = 0; cube_case < kCubeCases; ++cube_case) {
    std::set<DirectedSide> outline;
    for (const CubeLoop& loop : contourLoops(cube_case)) {
      for (size_t i = 0; i < loop.size(); ++i) outline.insert({loop[i], loop[(i + 1) % loop.size()]});
    }
    EXPECT_EQ(boundarySides(cube_case), outline) << "case " << cube_case;
    EXPECT_LE(cubeTriangles(cube_case).size(), static_cast<size_t>(kMaxCubeTriangles));
    for (const CubeTriangle& triangle : cubeTriangles(cube_case)) {
      for (int i = 0; i < 3; ++i) {
        const DirectedSide side(triangle[i], triangle[(i + 1) % 3]);
        if (shareFace(triangle[i], triangle[(i + 1) % 3])) {
          EXPECT_EQ(outline.count(side), 1u) << "case " << cube_case;
        }
      }
    }
  }
}

TEST(MarchingCubesTable, neighbouringCellsAgreeOnTheirFace) {
  for (int axis = 0; axis < 3; ++axis) {
    std::map<int, std::set<DirectedSide>> of_signs;
    for (int cube_case = 0; cube_case < kCubeCases; ++cube_case) {
      const auto sides = sidesOnFace(cube_case, axis, 1);
      const auto known = of_signs.emplace(faceSigns(cube_case, axis, 1), sides);
      EXPECT_EQ(known.first->second, sides) << "case " << cube_case << " axis " << axis;
    }
    for (int cube_case = 0; cube_case < kCubeCases; ++cube_case) {
      std::set<DirectedSide> opposite;
      for (const DirectedSide& side : of_signs.at(faceSigns(cube_case, axis, 0))) {
        opposite.insert({side.second, side.first});
      }
      EXPECT_EQ(sidesOnFace(cube_case, axis, 0), opposite) << "case " << cube_case << " axis " << axis;
    }
  }
}

TEST(MarchingCubesTable, singleCornersFaceAwayFromTheInside) {
  for (int corner = 0; corner < 8; ++corner) {
    for (const bool inside : {true, false}) {
      const int cube_case = inside ? 1 << corner : 255 & ~(1 << corner);
      const std::vector<CubeTriangle> triangles = cubeTriangles(cube_case);
      ASSERT_EQ(triangles.size(), 1u);
      const Eigen::Vector3d a = midpoint(triangles[0][0]);
      const Eigen::Vector3d normal = (midpoint(triangles[0][1]) - a).cross(midpoint(triangles[0][2]) - a);
      EXPECT_GT(normal.dot(a - cornerPoint(corner)) * (inside ? 1.0 : -1.0), 0.0) << "case " << cube_case;
    }
  }
}

TEST(MarchingCubesTable, insideCornersOfAnAmbiguousFaceAreSeparated) {
  EXPECT_EQ(contourLoops(0b00001001).size(), 2u);
  EXPECT_EQ(contourLoops(0b11110110).size(), 1u);
}

TEST(MarchingCubesTable, packsTrianglesForTheKernels) {
  const std::vector<uint8_t> table = marchingCubesTable();
  ASSERT_EQ(table.size(), static_cast<size_t>(kCubeCases * kCubeCaseBytes));
  for (int cube_case = 0; cube_case < kCubeCases; ++cube_case) {
    const uint8_t* entry = table.data() + cube_case * kCubeCaseBytes;
    const std::vector<CubeTriangle> triangles = cubeTriangles(cube_case);
    ASSERT_EQ(entry[0], triangles.size());
    for (size_t i = 0; i < 3 * triangles.size(); ++i) EXPECT_EQ(entry[1 + i], triangles[i / 3][i % 3]);
  }
}

}  // namespace
}  // namespace depth_fusion
