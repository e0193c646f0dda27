// The least-squares problem of a pose graph.
#pragma once

#include <memory>
#include <vector>

#include "depth_fusion/loops/pose_graph.h"

namespace depth_fusion {

class GraphSolver {
 public:
  // `parts`: for each node the lowest of its part, which stays. The edges that are not undone count.
  GraphSolver(const std::vector<Pose>& poses, const std::vector<GraphEdge>& edges,
              const std::vector<uint32_t>& parts);
  ~GraphSolver();

  void addGravity(size_t node, const Eigen::Vector3d& down_D, const Eigen::Vector3d& down_W,
                  double sigma_rad);

  // Return the number of iterations. The second trusts no loop that the others contradict by more.
  int solve();
  int solveRobustly(double max_sigmas);

  Pose pose(size_t node) const;
  // The loops that are so far from the poses.
  std::vector<size_t> contradicted(double max_sigmas) const;

 private:
  struct Problem;
  std::unique_ptr<Problem> problem_;
};

}  // namespace depth_fusion
