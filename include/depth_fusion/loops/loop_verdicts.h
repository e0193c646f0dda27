// Loops that fit wait here until others agree with them.
#pragma once

#include <vector>

#include "depth_fusion/loops/loop_candidate.h"
#include "depth_fusion/loops/pose_graph.h"

namespace depth_fusion {

class LoopVerdicts {
 public:
  explicit LoopVerdicts(const LoopParameters& parameters) : parameters_(parameters) {}

  // Takes in a loop that fits, whose new keyframe was passed after so much way. Returns the loops that are
  // confirmed by it, itself among them, once so many keyframes agree on how the two places lie to each other.
  // Sets how many do. Those that agree with confirmed ones belong to the same closure.
  std::vector<LoopCandidate> offer(LoopCandidate& loop, double way_m, const PoseGraph& graph, int needed);

 private:
  struct Waiting {
    LoopCandidate loop;
    double way_m = 0.0;
    bool is_confirmed = false;
  };

  bool agree(const LoopCandidate& a, const LoopCandidate& b, const PoseGraph& graph) const;

  LoopParameters parameters_;
  std::vector<Waiting> waiting_;
  uint32_t closures_ = 0;
};

}  // namespace depth_fusion
