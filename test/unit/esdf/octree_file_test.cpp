// Octrees as OctoMap reads them, FCL collides with them, and OMPL plans in them.
#include "depth_fusion/esdf/octree_file.h"

#include <fcl/geometry/octree/octree.h>
#include <fcl/narrowphase/collision.h>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>

#include "depth_fusion/common/error.h"
#include "support/known_space.h"
#include "support/temporary_folder.h"

namespace depth_fusion {
namespace {

// A wall at x = 1.6 m with a door of 0.6 m from y = 1 m on, in free space; what is high is not known.
CellState stateBehindTheDoor(const Eigen::Vector3d& p) {
  if (p.z() > 1.2) return CellState::kUnknown;
  const bool is_wall = p.x() > 1.6 && p.x() < 1.65;
  const bool is_door = p.y() > 1.0 && p.y() < 1.6;
  return is_wall && !is_door ? CellState::kOccupied : CellState::kFree;
}

class OctreeFile : public testing::Test {
 protected:
  std::shared_ptr<octomap::OcTree> read(const std::string& ending) {
    const std::string path = folder_ / ("space" + ending);
    size_ = writeOctree(path, space_);
    if (ending == ".bt") return std::make_shared<octomap::OcTree>(path);
    return std::shared_ptr<octomap::OcTree>(
        dynamic_cast<octomap::OcTree*>(octomap::AbstractOcTree::read(path)));
  }

  const TemporaryFolder folder_;
  const EsdfGrid space_ = knownSpace({4, 2, 2}, stateBehindTheDoor);
  OctreeSize size_;
};

TEST_F(OctreeFile, HasEveryCellAsItIs) {
  for (const std::string ending : {".bt", ".ot"}) {
    const auto tree = read(ending);
    ASSERT_NE(tree, nullptr);
    EXPECT_DOUBLE_EQ(tree->getResolution(), 0.05);
    space_.forEachCell([&](const Eigen::Vector3i& cell, CellState state, float) {
      const Eigen::Vector3d p = space_.middleOf(cell);
      const octomap::OcTreeNode* node = tree->search(p.x(), p.y(), p.z());
      ASSERT_EQ(node != nullptr, state != CellState::kUnknown) << p.transpose();
      if (node != nullptr) {
        ASSERT_EQ(tree->isNodeOccupied(node), state == CellState::kOccupied) << p.transpose();
      }
    });
    EXPECT_GT(size_.occupied, 400u);
    EXPECT_GT(size_.free, 40000u);
    EXPECT_LT(tree->getNumLeafNodes(), size_.free / 10) << "equal cells are joined";
  }
}

bool collides(const fcl::CollisionObjectd& space, const Eigen::Vector3d& p, double radius_m) {
  fcl::CollisionObjectd ball(std::make_shared<fcl::Sphered>(radius_m));
  ball.setTranslation(p);
  ball.computeAABB();
  fcl::CollisionResultd result;
  return fcl::collide(&ball, &space, fcl::CollisionRequestd(), result) > 0;
}

TEST_F(OctreeFile, APlannerFindsTheDoor) {
  fcl::CollisionObjectd space(std::make_shared<fcl::OcTreed>(read(".bt")));
  EXPECT_TRUE(collides(space, {1.6, 0.5, 0.6}, 0.1));
  EXPECT_FALSE(collides(space, {1.6, 1.3, 0.6}, 0.2));
  EXPECT_TRUE(collides(space, {1.6, 1.3, 0.6}, 0.4));

  namespace ob = ompl::base;
  const auto plane = std::make_shared<ob::RealVectorStateSpace>(2);
  plane->setBounds(0.2, 1.4);
  ob::RealVectorBounds bounds(2);
  bounds.setLow(0.2);
  bounds.setHigh(0, 3.0);
  bounds.setHigh(1, 1.4);
  plane->setBounds(bounds);
  ompl::geometric::SimpleSetup setup(plane);
  setup.setStateValidityChecker([&](const ob::State* state) {
    const double* p = state->as<ob::RealVectorStateSpace::StateType>()->values;
    return !collides(space, {p[0], p[1], 0.6}, 0.2);
  });
  setup.getSpaceInformation()->setStateValidityCheckingResolution(0.005);
  setup.setPlanner(std::make_shared<ompl::geometric::RRTConnect>(setup.getSpaceInformation()));
  ob::ScopedState<> start(plane), goal(plane);
  start[0] = 0.5;
  start[1] = 0.4;
  goal[0] = 2.7;
  goal[1] = 0.4;
  setup.setStartAndGoalStates(start, goal);
  ASSERT_EQ(setup.solve(60.0), ob::PlannerStatus::EXACT_SOLUTION);
  setup.getSolutionPath().interpolate(200);
  for (const ob::State* state : setup.getSolutionPath().getStates()) {
    const double* p = state->as<ob::RealVectorStateSpace::StateType>()->values;
    if (std::abs(p[0] - 1.625) > 0.05) continue;
    EXPECT_GT(p[1], 1.15);
    EXPECT_LT(p[1], 1.45);
  }
}

TEST_F(OctreeFile, SaysWhatIsWrong) {
  EXPECT_THROW(writeOctree(folder_ / "space.ply", space_), Error);
  EXPECT_THROW(writeOctree(folder_ / "no/folder.bt", space_), Error);
  EXPECT_THROW(writeOctree(folder_ / "space.bt", EsdfGrid(0.05, 2.0)), Error);
}

}  // namespace
}  // namespace depth_fusion
