#include "depth_fusion/loops/pose_graph.h"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "depth_fusion/common/error.h"
#include "loops/graph_solver.h"

namespace depth_fusion {
namespace {

uint32_t rootOf(std::vector<uint32_t>& parents, uint32_t node) {
  while (parents[node] != node) node = parents[node] = parents[parents[node]];
  return node;
}

}  // namespace

Matrix6d driftCovariance(const Pose& T_from_to, double way_m, const LoopParameters& parameters) {
  constexpr double kTremor_m = 0.001, kTremor_rad = 0.0005;  // of every pose
  const double way = way_m * parameters.correlated_way_m;
  const double turn = rotationAngle(T_from_to) * parameters.correlated_way_m;
  const auto variance = [&](double per_m, double per_rad, double tremor) {
    return per_m * per_m * way + per_rad * per_rad * turn + tremor * tremor;
  };
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(
      variance(parameters.drift_rad_per_m, parameters.drift_rad_per_rad, kTremor_rad)),
      Eigen::Vector3d::Constant(variance(parameters.drift_m_per_m, parameters.drift_m_per_rad, kTremor_m));
  const Matrix6d to_from = adjoint(T_from_to);
  const Matrix6d about_to = variances.asDiagonal();
  return to_from * about_to * to_from.transpose();
}

PoseGraph::PoseGraph(const LoopParameters& parameters) : parameters_(parameters) {
  validate(parameters_.table());
}

uint32_t PoseGraph::addNode(const Pose& T_W_D, const std::optional<Eigen::Vector3d>& down_D) {
  Node node;
  node.T_W_D = orthonormalized(T_W_D);
  if (down_D) node.down_D = down_D->normalized();
  nodes_.push_back(std::move(node));
  return static_cast<uint32_t>(nodes_.size() - 1);
}

void PoseGraph::addEdge(GraphEdge edge) {
  check(edge.from < nodes_.size() && edge.to < nodes_.size() && edge.from != edge.to,
        "an edge of the pose graph has no two nodes");
  for (const uint32_t node : {edge.from, edge.to})
    nodes_[node].edges.push_back(static_cast<uint32_t>(edges_.size()));
  edges_.push_back(std::move(edge));
}

void PoseGraph::addWay(uint32_t from, uint32_t to, const Pose& T_from_to, double way_m,
                       const Matrix6d& covariance) {
  addEdge({from, to, orthonormalized(T_from_to), driftCovariance(T_from_to, way_m, parameters_) + covariance,
           way_m});
}

size_t PoseGraph::addLoop(uint32_t from, uint32_t to, const Pose& T_from_to, const Matrix6d& covariance,
                          uint32_t closure) {
  const std::vector<uint32_t> part = parts();
  addEdge({from, to, orthonormalized(T_from_to), covariance, 0.0, true, closure});
  if (part[from] != part[to]) {
    const bool to_moves = part[from] < part[to];
    const Pose T_W_to = pose(from) * T_from_to, T_W_from = pose(to) * T_from_to.inverse();
    const Pose motion = to_moves ? T_W_to * pose(to).inverse() : T_W_from * pose(from).inverse();
    for (uint32_t node = 0; node < nodes_.size(); ++node) {
      if (part[node] == (to_moves ? part[to] : part[from]))
        nodes_[node].T_W_D = orthonormalized(motion * nodes_[node].T_W_D);
    }
  }
  return edges_.size() - 1;
}

std::vector<uint32_t> PoseGraph::parts() const {
  std::vector<uint32_t> parents(nodes_.size());
  std::iota(parents.begin(), parents.end(), 0u);
  for (const GraphEdge& edge : edges_) {
    if (edge.is_undone) continue;
    const uint32_t a = rootOf(parents, edge.from), b = rootOf(parents, edge.to);
    parents[std::max(a, b)] = std::min(a, b);
  }
  for (uint32_t node = 0; node < nodes_.size(); ++node) parents[node] = rootOf(parents, node);
  return parents;
}

// It may ask for so many standard deviations of drift; beside that, its loops have noise.
double PoseGraph::allowance(size_t loops) const {
  constexpr double kOfALoop = 12.0;  // twice what is to be expected of six residuals
  return parameters_.max_closure_sigmas * parameters_.max_closure_sigmas +
         kOfALoop * static_cast<double>(loops);
}

std::map<uint32_t, size_t> PoseGraph::closures() const {
  std::map<uint32_t, size_t> loops;
  for (const GraphEdge& edge : edges_) {
    if (edge.is_loop && !edge.is_undone) ++loops[edge.closure];
  }
  return loops;
}

std::set<uint32_t> PoseGraph::undone() const {
  std::set<uint32_t> closures;
  for (const GraphEdge& edge : edges_) {
    if (edge.is_undone) closures.insert(edge.closure);
  }
  return closures;
}

void PoseGraph::setUndone(const std::set<uint32_t>& closures) {
  for (GraphEdge& edge : edges_) edge.is_undone = edge.is_loop && closures.count(edge.closure) > 0;
}

GraphSolver PoseGraph::solver(const std::vector<Pose>& start) const {
  GraphSolver solver(start, edges_, parts());
  for (size_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i].down_D)
      solver.addGravity(i, *nodes_[i].down_D, Eigen::Vector3d::UnitY(), parameters_.gravity_sigma_rad);
  }
  return solver;
}

double PoseGraph::solveFrom(const std::vector<Pose>& start, GraphChange& change) {
  GraphSolver problem = solver(start);
  change.iterations += problem.solve();
  for (size_t i = 0; i < nodes_.size(); ++i) nodes_[i].T_W_D = problem.pose(i);
  return problem.strain();
}

std::optional<uint32_t> PoseGraph::mostStraining(const std::vector<Pose>& start, GraphChange& change) const {
  GraphSolver problem = solver(start);
  change.iterations += problem.solve();
  const double strain = problem.strain();
  double most = 0.0;
  std::optional<uint32_t> found;
  for (const auto& [closure, loops] : closures()) {
    const double relieved = strain - problem.strainWithout(closure) - allowance(loops);
    if (relieved <= most) continue;
    most = relieved;
    found = closure;
  }
  return found;
}

GraphChange PoseGraph::solve() {
  GraphChange change;
  std::vector<Pose> before;
  for (const Node& node : nodes_) before.push_back(node.T_W_D);
  double strain = solveFrom(before, change);
  if (strain > strain_ + allowance(0)) {
    const std::set<uint32_t> undone_before = undone();
    std::set<uint32_t> undone_now;
    setUndone(undone_now);
    while (const std::optional<uint32_t> closure = mostStraining(before, change)) {
      undone_now.insert(*closure);
      setUndone(undone_now);
    }
    strain = solveFrom(before, change);
    std::set_difference(undone_now.begin(), undone_now.end(), undone_before.begin(), undone_before.end(),
                        std::back_inserter(change.undone));
    std::set_difference(undone_before.begin(), undone_before.end(), undone_now.begin(), undone_now.end(),
                        std::back_inserter(change.restored));
  }
  strain_ = strain;
  for (size_t i = 0; i < nodes_.size(); ++i) {
    const double move_m = (before[i].inverse() * nodes_[i].T_W_D).translation().norm();
    change.largest_move_m = std::max(change.largest_move_m, move_m);
  }
  return change;
}

size_t PoseGraph::bytes() const {
  size_t bytes = nodes_.capacity() * sizeof(Node) + edges_.capacity() * sizeof(GraphEdge);
  for (const Node& node : nodes_) bytes += node.edges.capacity() * sizeof(uint32_t);
  return bytes;
}

}  // namespace depth_fusion
