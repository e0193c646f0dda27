// Distances of simulated scenes against the exact ones, and what becomes of them while the map changes.
#include "depth_fusion/esdf/esdf.h"

#include <gtest/gtest.h>

#include "depth_fusion/common/percentile.h"
#include "depth_fusion/esdf/floor_grid.h"
#include "support/esdf_scene.h"

namespace depth_fusion {
namespace {

struct Errors {
  std::vector<double> sizes;  // in cells
  size_t wrong_signs = 0, known = 0;

  double mean() const { return std::accumulate(sizes.begin(), sizes.end(), 0.0) / sizes.size(); }
};

// Those of all the cells whose distance is known.
Errors errorsOf(const EsdfGrid& grid, const Scene& scene) {
  Errors errors;
  grid.forEachCell([&](const Eigen::Vector3i& cell, CellState, float distance_m) {
    if (std::isnan(distance_m)) return;
    const double exact_m = scene.distance(grid.middleOf(cell));
    const double bounded_m = std::min(exact_m, grid.maxDistance_m());
    ++errors.known;
    errors.sizes.push_back(std::abs(distance_m - bounded_m) / grid.cellSize_m());
    if (std::abs(exact_m) > 0.015 && (distance_m > 0.0f) != (exact_m > 0.0)) ++errors.wrong_signs;
  });
  return errors;
}

TEST(Esdf, DistancesAreThoseOfTheScene) {
  for (const float cell_m : {0.05f, 0.03f}) {
    EsdfScene fused(closedRoom(), cell_m);
    fused.lookAround(48);
    const Errors errors = errorsOf(fused.esdf().grid(), fused.scene());
    EXPECT_GT(errors.known, static_cast<size_t>(0.8 * kRoomVolume_m3 / (cell_m * cell_m * cell_m)));
    EXPECT_LT(errors.mean(), 0.5) << cell_m;
    EXPECT_LT(percentile(errors.sizes, 0.99), 1.5) << cell_m;
    // At the edges of things the map itself has a few voxels with the wrong sign.
    EXPECT_LE(errors.wrong_signs, errors.known / 10000);
  }
}

TEST(Esdf, IsTheSameInStepsAndAtOnce) {
  EsdfScene fused(closedRoom(), 0.05f);
  fused.lookAround(24);
  const EsdfGrid in_steps = fused.esdf().grid();
  fused.esdf().computeAll();
  StageTimers timers;
  EXPECT_GE(fused.esdf().update(timers).size(), in_steps.blocks().size());
  ASSERT_EQ(fused.esdf().grid().blocks().size(), in_steps.blocks().size());
  for (const auto& [index, block] : fused.esdf().grid().blocks()) {
    const EsdfGrid::Block& before = in_steps.blocks().at(index);
    EXPECT_EQ(block.steps, before.steps) << index.transpose();
    EXPECT_EQ(block.states, before.states) << index.transpose();
  }
}

TEST(Esdf, UpdatesOnlyWhereSomethingChanged) {
  EsdfScene fused(closedRoom(), 0.05f);
  fused.lookAround(24);
  StageTimers timers;
  EXPECT_TRUE(fused.esdf().update(timers).empty());
  EXPECT_FALSE(fused.esdf().readMap(timers));
  EXPECT_TRUE(fused.esdf().update(timers).empty());
}

TEST(Esdf, WhatWasTakenAwayIsFreeInDistancesAndGridWithin30Frames) {
  const Eigen::Vector3d middle(0.0, 1.0, 0.6);
  std::vector<Primitive> solids = closedRoom();
  solids.push_back(box(middle, {0.3, 0.3, 0.3}, {}));
  EsdfScene fused(solids, 0.05f);
  const auto look = [&](int frames) {
    for (int i = 0; i < frames; ++i) fused.fuse(poseLookingAt({0.02 * (i % 5), -0.6, 1.0}, middle));
  };
  look(12);
  const Eigen::Vector3d front = middle - Eigen::Vector3d(0.0, 0.15, 0.0);
  const EsdfGrid& grid = fused.esdf().grid();
  EXPECT_EQ(grid.stateAt(grid.cellAt(front)), CellState::kOccupied);
  EXPECT_FALSE(grid.distances({middle}).front().is_known);
  FloorGridParameters floor;
  floor.find_ground = false;
  EXPECT_EQ(floorGridOf(grid, floor).at(front.head<2>()), kFloorOccupied);
  fused.show(closedRoom());
  look(30);
  EXPECT_EQ(floorGridOf(grid, floor).at(front.head<2>()), kFloorFree);
  EXPECT_EQ(floorGridOf(grid, floor).at(middle.head<2>()), kFloorFree);
  EXPECT_EQ(grid.stateAt(grid.cellAt(front)), CellState::kFree);
  for (const Eigen::Vector3d& p : {front, middle}) {
    const EsdfSample sample = grid.distances({p}).front();
    EXPECT_TRUE(sample.is_known);
    EXPECT_NEAR(sample.distance_m, fused.scene().distance(p), 0.05);
  }
  fused.show(solids);  // and what comes hides what was free
  look(30);
  EXPECT_EQ(grid.stateAt(grid.cellAt(front)), CellState::kOccupied);
  EXPECT_FALSE(grid.distances({middle - Eigen::Vector3d(0.0, 0.05, 0.0)}).front().is_known);
}

TEST(Esdf, GradientsLeadAwayFromSurfaces) {
  EsdfScene fused(closedRoom(), 0.05f);
  fused.lookAround(48);
  size_t known = 0;
  for (double x = -1.0; x <= 1.0; x += 0.13) {
    for (double y = -0.8; y <= 0.8; y += 0.13) {
      const Eigen::Vector3d p(x, y, 0.25);  // the floor is nearest
      if (std::abs(fused.scene().distance(p) - 0.25) > 1e-6) continue;
      const EsdfSample sample = fused.esdf().grid().distances({p}).front();
      if (!sample.is_known) continue;
      ++known;
      EXPECT_NEAR(sample.distance_m, 0.25, 0.02);
      EXPECT_GT(sample.gradient.z(), 0.8);
      EXPECT_LT(sample.gradient.norm(), 1.2);
    }
  }
  EXPECT_GT(known, 50u);
}

TEST(Esdf, WhatNobodySawIsUnknown) {
  EsdfScene fused(closedRoom(), 0.05f);
  fused.fuse(poseLookingAt({0.0, 0.0, 1.2}, {0.0, 1.5, 1.2}));
  const EsdfGrid& grid = fused.esdf().grid();
  const std::vector<EsdfSample> samples =
      grid.distances({{0.0, -0.8, 1.2}, {0.0, 2.5, 1.2}, {1e9, 0.0, 0.0}, {NAN, 0.0, 0.0}});
  for (const EsdfSample& sample : samples) EXPECT_FALSE(sample.is_known);
  EXPECT_EQ(grid.stateAt(grid.cellAt({0.0, -0.8, 1.2})), CellState::kUnknown);
}

TEST(Esdf, ForgetsAMapThatWasReset) {
  EsdfScene fused(closedRoom(), 0.05f);
  fused.lookAround(4);
  EXPECT_FALSE(fused.esdf().grid().blocks().empty());
  fused.map().reset(Eigen::Vector3d::Zero());
  StageTimers timers;
  EXPECT_TRUE(fused.esdf().readMap(timers));
  fused.esdf().update(timers);
  EXPECT_TRUE(fused.esdf().grid().blocks().empty());
}

TEST(Esdf, SaysWhatItLeavesOut) {
  EsdfScene fused(closedRoom(), 0.05f, 1);
  fused.lookAround(8);
  EXPECT_NE(fused.esdf().problem().find("esdf/memory_mib"), std::string::npos) << fused.esdf().problem();
  EXPECT_FALSE(fused.esdf().grid().blocks().empty());
}

TEST(Esdf, RefusesDistancesOfTooManyCells) {
  EsdfParameters parameters;
  parameters.voxel_size_m = 0.02f;
  parameters.max_distance_m = 3.0f;
  BlockMap map(compute(), esdfSceneMap());
  try {
    Esdf esdf(compute(), map, parameters);
    FAIL() << "150 cells";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("esdf/max_distance_m is 150 cells"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace depth_fusion
