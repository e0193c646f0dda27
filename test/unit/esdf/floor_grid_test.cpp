// Flat grids of rooms: against exact floor plans, on slopes and stairs, and as files.
#include "depth_fusion/esdf/floor_grid.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "support/esdf_scene.h"
#include "support/known_space.h"
#include "support/temporary_folder.h"

namespace depth_fusion {
namespace {

// Ground at a height, free space above it, and, where `isObstacle`, something that stands on it.
EsdfGrid spaceOver(const std::function<double(double x)>& ground_m,
                   const std::function<bool(const Eigen::Vector3d&)>& isObstacle) {
  return knownSpace({4, 2, 3}, [&](const Eigen::Vector3d& p) {
    const double above_m = p.z() - ground_m(p.x());
    if (above_m < -0.05) return CellState::kUnknown;
    if (above_m < 0.0 || isObstacle({p.x(), p.y(), above_m})) return CellState::kOccupied;
    return p.y() > 1.3 ? CellState::kUnknown : CellState::kFree;
  });
}

TEST(FloorGrid, HasWhatStandsBetweenTheHeights) {
  const EsdfGrid space = spaceOver([](double) { return 0.2; },
                                   [](const Eigen::Vector3d& p) {
                                     if (p.x() < 0.4) return p.z() < 0.08;  // a doorstep
                                     if (p.x() < 0.8) return p.z() < 0.3;   // a box
                                     if (p.x() < 1.2) return p.z() > 1.9;   // a ceiling
                                     return false;
                                   });
  const FloorGrid grid = floorGridOf(space, {});
  EXPECT_EQ(grid.columns, 64);
  EXPECT_EQ(grid.rows, 32);
  EXPECT_EQ(grid.at({0.2, 0.5}), kFloorFree);
  EXPECT_EQ(grid.at({0.6, 0.5}), kFloorOccupied);
  EXPECT_EQ(grid.at({1.0, 0.5}), kFloorFree);
  EXPECT_EQ(grid.at({2.0, 0.5}), kFloorFree);
  EXPECT_EQ(grid.at({2.0, 1.5}), kFloorUnknown);
  EXPECT_EQ(grid.at({-1.0, 0.5}), kFloorUnknown);
}

TEST(FloorGrid, FollowsSlopesAndStairs) {
  const auto slope = [](double x) { return 0.1 + 0.3 * std::max(0.0, x - 1.0); };
  const auto stairs = [](double x) { return 0.1 + 0.15 * std::max(0.0, std::floor((x - 1.0) / 0.3)); };
  const auto nothing = [](const Eigen::Vector3d&) { return false; };
  const auto count = [](const FloorGrid& grid) {
    return std::count(grid.cells.begin(), grid.cells.end(), kFloorOccupied);
  };
  FloorGridParameters climbing;
  climbing.max_step_m = 0.2f;
  EXPECT_EQ(count(floorGridOf(spaceOver(slope, nothing), {})), 0);
  EXPECT_EQ(count(floorGridOf(spaceOver(stairs, nothing), climbing)), 0);
  FloorGridParameters flat;
  flat.max_step_m = 0.0f;
  EXPECT_GT(count(floorGridOf(spaceOver(slope, nothing), flat)), 200);
  EXPECT_GT(count(floorGridOf(spaceOver(stairs, nothing), {})), 200);
}

TEST(FloorGrid, TakesTheGroundThatItIsGiven) {
  const EsdfGrid space = spaceOver([](double) { return 0.2; },
                                   [](const Eigen::Vector3d& p) { return p.x() < 0.5 && p.z() < 0.5; });
  FloorGridParameters parameters;
  parameters.find_ground = false;
  parameters.max_step_m = 0.0f;
  parameters.ground_z_m = 0.2f;
  EXPECT_EQ(floorGridOf(space, parameters).at({0.2, 0.5}), kFloorOccupied);
  parameters.ground_z_m = 0.8f;
  EXPECT_EQ(floorGridOf(space, parameters).at({0.2, 0.5}), kFloorFree);
}

// Whether anything of the scene is in the column about a cell, between the heights.
bool isFreeIn(const Scene& scene, const FloorGrid& grid, int column, int row) {
  const Eigen::Vector2d corner =
      grid.cell_size_m * (grid.first + Eigen::Vector2i(column, row)).cast<double>();
  for (double z = 0.12; z < 1.8; z += 0.02) {
    for (int i = 0; i < 25; ++i) {
      const Eigen::Vector2d p = corner + grid.cell_size_m * Eigen::Vector2d(i % 5 + 0.5, i / 5 + 0.5) / 5.0;
      if (scene.distance({p.x(), p.y(), z}) <= 0.0) return false;
    }
  }
  return true;
}

TEST(FloorGrid, IsTheFloorPlanOfARoom) {
  std::vector<Primitive> solids = closedRoom();
  solids.push_back(box({0.9, -0.9, 0.3}, {0.5, 0.4, 0.6}, {}, 0.3));
  solids.push_back(cylinder({-1.0, 0.8, -0.1}, {-1.0, 0.8, 0.8}, 0.2, {}));
  EsdfScene fused(solids, 0.05f);
  fused.lookAround(72);
  const FloorGrid grid = floorGridOf(fused.esdf().grid(), {});
  size_t in_both = 0, in_either = 0;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const bool is_free = grid.cells[grid.place(column, row)] == kFloorFree;
      const bool should_be = isFreeIn(fused.scene(), grid, column, row);
      in_both += is_free && should_be;
      in_either += is_free || should_be;
    }
  }
  std::printf("IoU %.4f\n", static_cast<double>(in_both) / static_cast<double>(in_either));
  EXPECT_GT(in_either, 2000u);
  EXPECT_GT(static_cast<double>(in_both), 0.97 * static_cast<double>(in_either));
}

TEST(FloorGrid, IsWrittenAsMapSaverDoes) {
  const TemporaryFolder folder;
  FloorGrid grid;
  grid.cell_size_m = 0.05;
  grid.first = {-2, 3};
  grid.columns = 3;
  grid.rows = 2;
  grid.cells = {0, 100, -1, -1, -1, 0};
  writeFloorGrid(folder / "floor", grid);
  std::ostringstream image, text;
  image << std::ifstream(folder / "floor.pgm", std::ios::binary).rdbuf();
  text << std::ifstream(folder / "floor.yaml").rdbuf();
  EXPECT_EQ(image.str().substr(0, 3), "P5\n");
  EXPECT_EQ(image.str().substr(image.str().size() - 6), "\xcd\xcd\xfe\xfe" + std::string("\0", 1) + "\xcd");
  EXPECT_NE(text.str().find("image: floor.pgm\nresolution: 0.05"), std::string::npos) << text.str();
  EXPECT_NE(text.str().find("origin: [-0.1"), std::string::npos) << text.str();
  EXPECT_NE(text.str().find("occupied_thresh: 0.65\nfree_thresh: 0.196\n"), std::string::npos) << text.str();
  EXPECT_THROW(writeFloorGrid(folder / "no/folder", grid), Error);
  EXPECT_THROW(writeFloorGrid(folder / "floor", FloorGrid()), Error);
}

}  // namespace
}  // namespace depth_fusion
