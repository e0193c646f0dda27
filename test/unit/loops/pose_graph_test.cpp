#include "depth_fusion/loops/pose_graph.h"

#include <gtest/gtest.h>

#include <random>

#include "loops/graph_costs.h"
#include "loops/graph_way.h"

namespace depth_fusion {
namespace {

constexpr double kPi = 3.141592653589793;

Pose randomPose(std::mt19937& random, double angle_rad, double length_m) {
  std::normal_distribution<double> normal;
  Vector6d twist;
  for (double& value : twist) value = normal(random);
  twist.head<3>() *= angle_rad;
  twist.tail<3>() *= length_m;
  return poseFromTwist(twist);
}

template <class Cost, int kResiduals, int kTwists>
void expectDerivatives(const Cost& cost, std::array<Vector6d, kTwists> twists) {
  using Residual = Eigen::Matrix<double, kResiduals, 1>;
  using Jacobian = Eigen::Matrix<double, kResiduals, 6, Eigen::RowMajor>;
  const auto residualOf = [&] {
    Residual residual;
    std::array<const double*, kTwists> parameters;
    for (size_t i = 0; i < kTwists; ++i) parameters[i] = twists[i].data();
    cost.Evaluate(parameters.data(), residual.data(), nullptr);
    return residual;
  };
  std::array<Jacobian, kTwists> analytic;
  std::array<const double*, kTwists> parameters;
  std::array<double*, kTwists> jacobians;
  for (size_t i = 0; i < kTwists; ++i) {
    parameters[i] = twists[i].data();
    jacobians[i] = analytic[i].data();
  }
  Residual residual;
  ASSERT_TRUE(cost.Evaluate(parameters.data(), residual.data(), jacobians.data()));
  constexpr double kStep = 1e-6;
  for (size_t i = 0; i < kTwists; ++i) {
    for (int k = 0; k < 6; ++k) {
      const double value = twists[i][k];
      twists[i][k] = value + kStep;
      const Residual after = residualOf();
      twists[i][k] = value - kStep;
      const Residual numerical = (after - residualOf()) / (2.0 * kStep);
      twists[i][k] = value;
      EXPECT_LT((analytic[i].col(k) - numerical).norm(), 1e-4 * (1.0 + numerical.norm())) << i << " " << k;
    }
  }
}

TEST(PoseGraph, DerivativesAreThoseOfTheResiduals) {
  std::mt19937 random(1);
  for (const double angle_rad : {1e-6, 0.1, 1.0}) {
    const Pose a = randomPose(random, 1.0, 3.0), b = randomPose(random, 1.0, 3.0);
    GraphEdge edge;
    edge.T_from_to = orthonormalized(a.inverse() * b * randomPose(random, 0.3 * angle_rad, 0.1));
    const Matrix6d root = Matrix6d::Random();
    edge.covariance = root * root.transpose() + 0.1 * Matrix6d::Identity();
    EdgeCost cost(edge, a, b);
    const Vector6d twist_a = twistFromPose(randomPose(random, 0.5 * angle_rad, 0.3));
    const Vector6d twist_b = twistFromPose(randomPose(random, 0.5 * angle_rad, 0.3));
    expectDerivatives<EdgeCost, 6, 2>(cost, {twist_a, twist_b});
    const GravityCost gravity(a, Eigen::Vector3d(0.1, 1.0, 0.2).normalized(), Eigen::Vector3d::UnitY(), 0.02);
    expectDerivatives<GravityCost, 3, 1>(gravity, {twist_a});
  }
}

TEST(PoseGraph, ResidualsAreInStandardDeviations) {
  std::mt19937 random(2);
  GraphEdge edge;
  edge.T_from_to = randomPose(random, 0.5, 2.0);
  edge.covariance = Vector6d(Vector6d::Constant(0.01)).cwiseAbs2().asDiagonal();
  const Pose from = randomPose(random, 1.0, 5.0);
  Vector6d off = Vector6d::Zero();
  off[4] = 0.03;
  const Pose to = from * poseFromTwist(off) * edge.T_from_to;
  const EdgeCost cost(edge, from, to);
  const Vector6d zero = Vector6d::Zero();
  const double* const parameters[] = {zero.data(), zero.data()};
  Vector6d residual;
  cost.Evaluate(parameters, residual.data(), nullptr);
  EXPECT_NEAR(residual.norm(), 3.0, 1e-6);
}

// A way round a square of so many keyframes a side, tracked with drift.
struct Square {
  std::vector<Pose> truth;
  PoseGraph graph;

  Square(int side, double turn_drift_rad, const LoopParameters& parameters = {}) : graph(parameters) {
    Pose T_W_D = Pose::Identity(), tracked = Pose::Identity();
    for (int i = 0; i < 4 * side; ++i) {
      truth.push_back(T_W_D);
      graph.addNode(tracked);
      Pose motion(Eigen::AngleAxisd((i + 1) % side == 0 ? kPi / 2.0 : 0.0, Eigen::Vector3d::UnitY()));
      motion.translation() = Eigen::Vector3d(0.0, 0.0, 0.5);
      const Pose drifted = motion * Pose(Eigen::AngleAxisd(turn_drift_rad, Eigen::Vector3d::UnitY()));
      if (i > 0) graph.addWay(i - 1, i, tracked_motion_, 0.5);
      tracked_motion_ = drifted;
      T_W_D = T_W_D * motion;
      tracked = tracked * drifted;
    }
  }

  Pose relation(uint32_t a, uint32_t b) const { return truth[a].inverse() * truth[b]; }
  double error_m(uint32_t node) const {
    return (graph.pose(node).translation() - truth[node].translation()).norm();
  }
  double largestError_m() const {
    double largest = 0.0;
    for (uint32_t i = 0; i < truth.size(); ++i) largest = std::max(largest, error_m(i));
    return largest;
  }

 private:
  Pose tracked_motion_;
};

Matrix6d loopCovariance() { return Vector6d(Vector6d::Constant(0.01)).cwiseAbs2().asDiagonal(); }

TEST(PoseGraph, ALoopTakesTheDriftOutOfTheWholeWay) {
  Square square(40, 0.001);
  const uint32_t last = 159;
  ASSERT_GT(square.error_m(last), 0.5);
  square.graph.addLoop(0, last, square.relation(0, last), loopCovariance(), 0);
  const GraphChange change = square.graph.solve();
  EXPECT_TRUE(change.undone.empty());
  EXPECT_LT(square.error_m(last), 0.03);
  EXPECT_LT(square.largestError_m(), 0.25) << "drift was spread evenly, and so is the correction";
  EXPECT_GT(change.largest_move_m, 0.5);
  EXPECT_TRUE(square.graph.pose(0).isApprox(Pose::Identity())) << "the first node stays";
}

TEST(PoseGraph, WithoutALoopNothingMoves) {
  Square square(10, 0.002);
  const Pose before = square.graph.pose(20);
  const GraphChange change = square.graph.solve();
  EXPECT_EQ(change.largest_move_m, 0.0);
  EXPECT_EQ(square.graph.pose(20).matrix(), before.matrix());
}

// The false loop stood alone, and all was bent to it; those that come later contradict it.
TEST(PoseGraph, ALoopThatOthersContradictIsUndone) {
  Square square(40, 0.001), without(40, 0.001);
  Pose wrong = square.relation(5, 130);
  wrong.translation() += Eigen::Vector3d(0.6, 0.0, 0.3);
  constexpr uint32_t kWrong = 7;
  const size_t wrong_edge = square.graph.addLoop(5, 130, wrong, loopCovariance(), kWrong);
  EXPECT_TRUE(square.graph.solve().undone.empty()) << "nothing contradicts it yet";
  for (Square* each : {&square, &without}) {
    const auto addTrue = [&](uint32_t from, uint32_t to, uint32_t closure) {
      each->graph.addLoop(from, to, each->relation(from, to), loopCovariance(), closure);
    };
    for (uint32_t i = 0; i < 4; ++i) addTrue(2 * i, 152 + 2 * i, 8);
    addTrue(10, 140, 9);
    addTrue(12, 128, 9);
  }
  const GraphChange change = square.graph.solve();
  ASSERT_EQ(change.undone, std::vector<uint32_t>{kWrong});
  EXPECT_TRUE(square.graph.edges()[wrong_edge].is_undone);
  without.graph.solve();
  for (const uint32_t node : {20u, 100u, 130u, 159u})
    EXPECT_LT((square.graph.pose(node).translation() - without.graph.pose(node).translation()).norm(), 2e-3)
        << "all is as if it had never been: " << node;
}

// Of two that contradict each other one has to go, and comes back when more say that it was right.
TEST(PoseGraph, AClosureThatWasUndoneComesBackIfOthersAgreeWithIt) {
  Square square(40, 0.001);
  Pose wrong = square.relation(5, 130);
  wrong.translation() += Eigen::Vector3d(0.6, 0.0, 0.3);
  square.graph.addLoop(5, 130, wrong, loopCovariance(), 0);
  square.graph.solve();
  square.graph.addLoop(6, 131, square.relation(6, 131), loopCovariance(), 1);
  const GraphChange first = square.graph.solve();
  ASSERT_EQ(first.undone.size(), 1u);
  square.graph.addLoop(7, 132, square.relation(7, 132), loopCovariance(), 2);
  square.graph.addLoop(8, 133, square.relation(8, 133), loopCovariance(), 3);
  const GraphChange second = square.graph.solve();
  for (const GraphEdge& edge : square.graph.edges()) {
    EXPECT_EQ(edge.is_undone, edge.is_loop && edge.closure == 0) << edge.closure;
  }
  EXPECT_EQ(second.restored.size(), first.undone[0] == 0 ? 0u : 1u);
}

TEST(PoseGraph, GravityTakesOutWhatTiltsTheWay) {
  for (const bool has_gravity : {false, true}) {
    PoseGraph graph{LoopParameters()};
    Pose tracked = Pose::Identity();
    const Pose motion = poseFromTwist((Vector6d() << 0.0, 0.0, 0.004, 0.0, 0.0, 0.5).finished());
    for (uint32_t i = 0; i < 60; ++i) {
      graph.addNode(tracked,
                    has_gravity ? std::optional<Eigen::Vector3d>(Eigen::Vector3d::UnitY()) : std::nullopt);
      if (i > 0) graph.addWay(i - 1, i, motion, 0.5);
      tracked = tracked * motion;
    }
    Pose back = Pose::Identity();
    back.translation().z() = 0.5;
    graph.addLoop(58, 59, back, loopCovariance(), 0);
    graph.solve();
    const double tilt_rad = std::acos(graph.pose(30).linear()(1, 1));
    if (has_gravity)
      EXPECT_LT(tilt_rad, 0.03);
    else
      EXPECT_GT(tilt_rad, 0.08);
  }
}

TEST(PoseGraph, ALoopMovesTheOtherPartTogether) {
  PoseGraph graph{LoopParameters()};
  Pose motion = Pose::Identity();
  motion.translation().x() = 1.0;
  graph.addNode(Pose::Identity());
  graph.addNode(motion);
  graph.addWay(0, 1, motion, 1.0);
  Pose elsewhere(Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ()));
  elsewhere.translation().y() = 50.0;
  graph.addNode(elsewhere);
  graph.addNode(elsewhere * motion);
  graph.addWay(2, 3, motion, 1.0);
  EXPECT_FALSE(GraphWays(graph, 3).relationFrom(0)) << "nothing holds them together";
  graph.addLoop(3, 1, Pose::Identity(), loopCovariance(), 0);
  graph.solve();
  EXPECT_TRUE(graph.pose(0).isApprox(Pose::Identity()));
  EXPECT_LT((graph.pose(2).translation() - Eigen::Vector3d::Zero()).norm(), 1e-6);
  EXPECT_LT((graph.pose(3).translation() - Eigen::Vector3d(1, 0, 0)).norm(), 1e-6);
  EXPECT_TRUE(GraphWays(graph, 3).relationFrom(0));
}

TEST(GraphWays, TakeTheShortWayOverALoopAndKnowHowSureItIs) {
  Square square(40, 0.0);
  const GraphRelation before = *GraphWays(square.graph, 159).relationFrom(0);
  EXPECT_NEAR(before.way_m, 79.5, 1e-9);
  EXPECT_LT((before.T_a_b.matrix() - square.relation(0, 159).matrix()).norm(), 1e-9);
  square.graph.addLoop(0, 158, square.relation(0, 158), loopCovariance(), 0);
  const GraphRelation after = *GraphWays(square.graph, 159).relationFrom(0);
  EXPECT_NEAR(after.way_m, 0.5, 1e-9);
  EXPECT_LT(after.covariance.trace(), 0.02 * before.covariance.trace());
}

// Draws ways with the drift that the covariance claims, and compares.
TEST(GraphWays, CovarianceIsThatOfTheDrift) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const LoopParameters parameters;
  const int kSteps = 20, kDraws = 400;
  Matrix6d drawn = Matrix6d::Zero(), claimed = Matrix6d::Zero();
  const Pose motion = poseFromTwist((Vector6d() << 0.0, 0.1, 0.0, 0.0, 0.0, 0.5).finished());
  for (int draw = 0; draw < kDraws; ++draw) {
    PoseGraph graph(parameters);
    Pose truth = Pose::Identity(), tracked = Pose::Identity();
    graph.addNode(tracked);
    for (uint32_t i = 0; i < kSteps; ++i) {
      const Matrix6d root = driftCovariance(motion, 0.5, parameters).llt().matrixL();
      Vector6d noise;
      for (double& value : noise) value = normal(random);
      const Pose measured = poseFromTwist(root * noise) * motion;
      truth = truth * motion;
      tracked = tracked * measured;
      graph.addNode(tracked);
      graph.addWay(i, i + 1, measured, 0.5);
    }
    const Vector6d twist = twistFromPose(tracked * truth.inverse());
    drawn += twist * twist.transpose() / kDraws;
    claimed += GraphWays(graph, kSteps).relationFrom(0)->covariance / kDraws;
  }
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(std::sqrt(drawn(i, i) / claimed(i, i)), 1.0, 0.15) << i;
}

}  // namespace
}  // namespace depth_fusion
