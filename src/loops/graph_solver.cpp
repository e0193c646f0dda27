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
constexpr int kIterationsOfRound = 4;
constexpr double kAnnealing = 2.0;  // by which the kernel narrows with each round

double squaredResidual(const EdgeCost& cost, const double* from, const double* to) {
  Vector6d residual;
  const double* const parameters[] = {from, to};
  cost.Evaluate(parameters, residual.data(), nullptr);
  return residual.squaredNorm() / (cost.weight() * cost.weight());
}

}  // namespace

struct GraphSolver::Problem {
  // Every node has a twist that is applied to where it was on the right.
  std::vector<Pose> starts;
  std::vector<Vector6d> twists;
  std::vector<std::unique_ptr<EdgeCost>> edges;
  std::vector<std::unique_ptr<GravityCost>> gravities;
  std::vector<std::pair<size_t, EdgeCost*>> loops;  // indices of edges
  const std::vector<GraphEdge>& graph;
  ceres::Problem ceres;

  explicit Problem(const std::vector<GraphEdge>& graph_edges) : graph(graph_edges), ceres(options()) {}

  static ceres::Problem::Options options() {
    ceres::Problem::Options options;
    options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }

  double* twistOf(size_t node) { return twists[node].data(); }

  double squaredResidualOf(const std::pair<size_t, EdgeCost*>& loop) {
    return squaredResidual(*loop.second, twistOf(graph[loop.first].from), twistOf(graph[loop.first].to));
  }

  int solve(int max_iterations) {
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
    : problem_(std::make_unique<Problem>(edges)) {
  problem_->starts = poses;
  problem_->twists.assign(poses.size(), Vector6d::Zero());
  std::set<uint32_t> parts_with_loops;
  for (const GraphEdge& edge : edges) {
    if (edge.is_loop && !edge.is_undone) parts_with_loops.insert(parts[edge.from]);
  }
  for (size_t i = 0; i < edges.size(); ++i) {
    const GraphEdge& edge = edges[i];
    if (edge.is_undone || parts_with_loops.count(parts[edge.from]) == 0) continue;
    problem_->edges.push_back(std::make_unique<EdgeCost>(edge, poses[edge.from], poses[edge.to]));
    problem_->ceres.AddResidualBlock(problem_->edges.back().get(), nullptr, problem_->twistOf(edge.from),
                                     problem_->twistOf(edge.to));
    if (edge.is_loop) problem_->loops.emplace_back(i, problem_->edges.back().get());
  }
  for (const uint32_t root : parts_with_loops)
    problem_->ceres.SetParameterBlockConstant(problem_->twistOf(root));
}

GraphSolver::~GraphSolver() = default;

void GraphSolver::addGravity(size_t node, const Eigen::Vector3d& down_D, const Eigen::Vector3d& down_W,
                             double sigma_rad) {
  if (!problem_->ceres.HasParameterBlock(problem_->twistOf(node))) return;
  problem_->gravities.push_back(
      std::make_unique<GravityCost>(problem_->starts[node], down_D, down_W, sigma_rad));
  problem_->ceres.AddResidualBlock(problem_->gravities.back().get(), nullptr, problem_->twistOf(node));
}

int GraphSolver::solve() {
  return problem_->ceres.NumResidualBlocks() == 0 ? 0 : problem_->solve(kMaxIterations);
}

int GraphSolver::solveRobustly(double max_sigmas) {
  const double scale = max_sigmas * max_sigmas;
  double widest = 0.0;
  for (const auto& loop : problem_->loops) widest = std::max(widest, problem_->squaredResidualOf(loop));
  int iterations = 0;
  for (double width = std::max(1.0, 2.0 * widest / scale);; width = std::max(1.0, width / kAnnealing)) {
    for (const auto& loop : problem_->loops) {
      const double kernel = width * scale;
      loop.second->setWeight(kernel / (kernel + problem_->squaredResidualOf(loop)));
    }
    iterations += problem_->solve(width > 1.0 ? kIterationsOfRound : kMaxIterations);
    if (width <= 1.0) return iterations;
  }
}

Pose GraphSolver::pose(size_t node) const {
  return orthonormalized(problem_->starts[node] * poseFromTwist(problem_->twists[node]));
}

std::vector<size_t> GraphSolver::contradicted(double max_sigmas) const {
  std::vector<size_t> result;
  for (const auto& loop : problem_->loops) {
    if (problem_->squaredResidualOf(loop) > max_sigmas * max_sigmas) result.push_back(loop.first);
  }
  return result;
}

}  // namespace depth_fusion
