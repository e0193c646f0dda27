// How keyframes lie in W: chained by the sensor's way, and held together by loops.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/loops/loop_parameters.h"

namespace depth_fusion {

class GraphSolver;

struct GraphEdge {
  uint32_t from = 0, to = 0;
  Pose T_from_to = Pose::Identity();
  Matrix6d covariance = Matrix6d::Identity();  // of the twist on the left
  double way_m = 0.0;                          // that the sensor went from one to the other; a loop has none
  bool is_loop = false;
  uint32_t closure = 0;    // of a loop: those of one closure are believed, or not, together
  bool is_undone = false;  // others contradict the loop; it does not count
};

// What solve() did.
struct GraphChange {
  std::vector<uint32_t> undone, restored;  // closures
  double largest_move_m = 0.0;             // of a node
  int iterations = 0;
};

// A least-squares problem over SE(3) in units of standard deviations (Lu and Milios 1997), solved by Ceres
// with analytic derivatives and a sparse Cholesky factorisation. A false loop bends the ways about it more
// than itself: what betrays it is by how much the graph is less strained without it.
class PoseGraph {
 public:
  explicit PoseGraph(const LoopParameters& parameters);

  // Nodes are numbered from 0 on. `down_D`: the measured direction of gravity, which is along y in W.
  uint32_t addNode(const Pose& T_W_D, const std::optional<Eigen::Vector3d>& down_D = std::nullopt);
  // The sensor went from one node to the other; the covariance is that of its drift on this way, and what the
  // tracker's own adds to it.
  void addWay(uint32_t from, uint32_t to, const Pose& T_from_to, double way_m,
              const Matrix6d& covariance = Matrix6d::Zero());
  // Returns the edge's index. Two parts of the graph that nothing held together before are moved together:
  // the one with the lowest node stays.
  size_t addLoop(uint32_t from, uint32_t to, const Pose& T_from_to, const Matrix6d& covariance,
                 uint32_t closure);

  // Finds the poses that fit all edges best. Where closures contradict each other, it undoes the fewest that
  // it takes, and restores others that were undone before. The lowest node of each part stays.
  GraphChange solve();

  size_t size() const { return nodes_.size(); }
  const Pose& pose(uint32_t node) const { return nodes_[node].T_W_D; }
  const std::vector<GraphEdge>& edges() const { return edges_; }
  // The edges that meet in a node, those that are undone among them.
  const std::vector<uint32_t>& edgesOf(uint32_t node) const { return nodes_[node].edges; }
  // For each node the lowest one that edges hold it together with.
  std::vector<uint32_t> parts() const;
  size_t bytes() const;

 private:
  struct Node {
    Pose T_W_D = Pose::Identity();
    std::optional<Eigen::Vector3d> down_D;
    std::vector<uint32_t> edges;
  };

  // Sets the poses, from where they were, and returns how strained the graph is.
  double solveFrom(const std::vector<Pose>& start, GraphChange& change);
  // Of the closures that count, the one without which the graph is less strained by most; none if it is not
  // by more than a closure may.
  std::optional<uint32_t> mostStraining(const std::vector<Pose>& start, GraphChange& change) const;
  // By how much a closure of so many loops may strain the graph.
  double allowance(size_t loops) const;
  // The closures that count, with the numbers of their loops.
  std::map<uint32_t, size_t> closures() const;
  std::set<uint32_t> undone() const;
  void setUndone(const std::set<uint32_t>& closures);
  GraphSolver solver(const std::vector<Pose>& start) const;
  void addEdge(GraphEdge edge);

  LoopParameters parameters_;
  std::vector<Node> nodes_;
  std::vector<GraphEdge> edges_;
  double strain_ = 0.0;  // the sum of all squares after the last solve()
};

// The covariance of the drift on the way (of the twist on the left of T_from_to).
Matrix6d driftCovariance(const Pose& T_from_to, double way_m, const LoopParameters& parameters);

}  // namespace depth_fusion
