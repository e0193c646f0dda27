#include "loops/graph_solver.h"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <set>

#include "loops/graph_costs.h"

namespace depth_fusion {
namespace {

constexpr int kMaxIterations = 30;

}  // namespace

struct GraphSolver::Problem {
  // Every node has a twist that is applied to where it was on the right.
  std::vector<Pose> starts;
  std::vector<Vector6d> twists;
  std::vector<std::unique_ptr<EdgeCost>> edges;
  std::vector<std::unique_ptr<GravityCost>> gravities;
  std::vector<std::pair<uint32_t, EdgeCost*>> loops;  // with their closures
  ceres::Problem ceres{options()};

  static ceres::Problem::Options options() {
    ceres::Problem::Options options;
    options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }

  double* twistOf(size_t node) { return twists[node].data(); }

  int solve(int max_iterations) {
    if (ceres.NumResidualBlocks() == 0) return 0;
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.max_num_iterations = max_iterations;
    options.initial_trust_region_radius = 1e8;
    options.function_tolerance = 1e-7;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &ceres, &summary);
    return static_cast<int>(summary.iterations.size());
  }
};

GraphSolver::GraphSolver(const std::vector<Pose>& poses, const std::vector<GraphEdge>& edges,
                         const std::vector<uint32_t>& parts)
    : problem_(std::make_unique<Problem>()) {
  problem_->starts = poses;
  problem_->twists.assign(poses.size(), Vector6d::Zero());
  std::set<uint32_t> parts_with_loops;
  for (const GraphEdge& edge : edges) {
    if (edge.is_loop && !edge.is_undone) parts_with_loops.insert(parts[edge.from]);
  }
  for (const GraphEdge& edge : edges) {
    if (edge.is_undone || parts_with_loops.count(parts[edge.from]) == 0) continue;
    problem_->edges.push_back(std::make_unique<EdgeCost>(edge, poses[edge.from], poses[edge.to]));
    problem_->ceres.AddResidualBlock(problem_->edges.back().get(), nullptr, problem_->twistOf(edge.from),
                                     problem_->twistOf(edge.to));
    if (edge.is_loop) problem_->loops.emplace_back(edge.closure, problem_->edges.back().get());
  }
  for (const uint32_t root : parts_with_loops)
    problem_->ceres.SetParameterBlockConstant(problem_->twistOf(root));
}

GraphSolver::~GraphSolver() = default;
GraphSolver::GraphSolver(GraphSolver&& other) noexcept = default;

void GraphSolver::addGravity(size_t node, const Eigen::Vector3d& down_D, const Eigen::Vector3d& down_W,
                             double sigma_rad) {
  if (!problem_->ceres.HasParameterBlock(problem_->twistOf(node))) return;
  problem_->gravities.push_back(
      std::make_unique<GravityCost>(problem_->starts[node], down_D, down_W, sigma_rad));
  problem_->ceres.AddResidualBlock(problem_->gravities.back().get(), nullptr, problem_->twistOf(node));
}

int GraphSolver::solve() { return problem_->solve(kMaxIterations); }

Pose GraphSolver::pose(size_t node) const {
  return orthonormalized(problem_->starts[node] * poseFromTwist(problem_->twists[node]));
}

double GraphSolver::strain() const {
  double cost = 0.0;  // half of the sum
  problem_->ceres.Evaluate(ceres::Problem::EvaluateOptions(), &cost, nullptr, nullptr, nullptr);
  return 2.0 * cost;
}

double GraphSolver::strainWithout(uint32_t closure) {
  const std::vector<Vector6d> twists = problem_->twists;
  const auto setWeight = [&](double weight) {
    for (const auto& [of_closure, cost] : problem_->loops) {
      if (of_closure == closure) cost->setWeight(weight);
    }
  };
  setWeight(0.0);
  problem_->solve(kMaxIterations);
  const double result = strain();
  setWeight(1.0);
  std::copy(twists.begin(), twists.end(), problem_->twists.begin());  // Ceres knows them by their places
  return result;
}

}  // namespace depth_fusion
