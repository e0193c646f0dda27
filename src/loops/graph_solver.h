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
  GraphSolver(GraphSolver&& other) noexcept;

  void addGravity(size_t node, const Eigen::Vector3d& down_D, const Eigen::Vector3d& down_W,
                  double sigma_rad);

  // Returns the number of iterations.
  int solve();
  Pose pose(size_t node) const;
  // The sum of the squares of all residuals, in standard deviations.
  double strain() const;
  // What it would be if a closure did not count; the poses stay as they are.
  double strainWithout(uint32_t closure);

 private:
  struct Problem;
  std::unique_ptr<Problem> problem_;
};

}  // namespace depth_fusion
