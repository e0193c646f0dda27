// How two keyframes lie to each other by the graph, and how sure that is.
#pragma once

#include <optional>
#include <vector>

#include "depth_fusion/loops/pose_graph.h"

namespace depth_fusion {

struct GraphRelation {
  Pose T_a_b = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  // of the twist on the left
  double way_m = 0.0;
};

// The shortest ways from one node to all others, over loops where they are shorter. Other ways could only
// make it surer how they lie, so that the covariance is an upper bound.
class GraphWays {
 public:
  GraphWays(const PoseGraph& graph, uint32_t from);

  // None: nothing holds them together.
  std::optional<double> way_m(uint32_t node) const;
  // How the node that the ways come from lies to another one, a.
  std::optional<GraphRelation> relationFrom(uint32_t a) const;

 private:
  const PoseGraph& graph_;
  uint32_t from_;
  std::vector<double> way_m_;
  std::vector<int> edge_;  // by which a node is reached; -1: none
};

}  // namespace depth_fusion
