#include "loops/graph_way.h"

#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace depth_fusion {
namespace {

constexpr double kUnreached = std::numeric_limits<double>::infinity();

uint32_t otherEnd(const GraphEdge& edge, uint32_t node) { return edge.from == node ? edge.to : edge.from; }

}  // namespace

GraphWays::GraphWays(const PoseGraph& graph, uint32_t from)
    : graph_(graph), from_(from), way_m_(graph.size(), kUnreached), edge_(graph.size(), -1) {
  using Reached = std::pair<double, uint32_t>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
  way_m_[from] = 0.0;
  front.emplace(0.0, from);
  while (!front.empty()) {
    const auto [way_m, node] = front.top();
    front.pop();
    if (way_m > way_m_[node]) continue;
    for (const uint32_t index : graph.edgesOf(node)) {
      const GraphEdge& edge = graph.edges()[index];
      const uint32_t next = otherEnd(edge, node);
      if (edge.is_undone || way_m + edge.way_m >= way_m_[next]) continue;
      way_m_[next] = way_m + edge.way_m;
      edge_[next] = static_cast<int>(index);
      front.emplace(way_m_[next], next);
    }
  }
}

std::optional<double> GraphWays::way_m(uint32_t node) const {
  if (way_m_[node] == kUnreached) return std::nullopt;
  return way_m_[node];
}

std::optional<GraphRelation> GraphWays::relationFrom(uint32_t a) const {
  if (way_m_[a] == kUnreached) return std::nullopt;
  const Pose T_a_W = graph_.pose(a).inverse();
  GraphRelation relation{orthonormalized(T_a_W * graph_.pose(from_)), Matrix6d::Zero(), way_m_[a]};
  for (uint32_t node = a; node != from_;) {
    const GraphEdge& edge = graph_.edges()[static_cast<size_t>(edge_[node])];
    const uint32_t next = otherEnd(edge, node);
    // The covariance stands where the edge begins.
    const Matrix6d to_a = adjoint(T_a_W * graph_.pose(edge.from));
    relation.covariance += to_a * edge.covariance * to_a.transpose();
    node = next;
  }
  return relation;
}

}  // namespace depth_fusion
