#include "depth_fusion/loops/loop_verdicts.h"

#include <algorithm>
#include <set>
#include <utility>

namespace depth_fusion {

// What the two loops and the way between their old keyframes say of the way between the new ones is what was
// tracked.
bool LoopVerdicts::agree(const LoopCandidate& a, const LoopCandidate& b, const PoseGraph& graph) const {
  const Pose T_old_old = graph.pose(a.old_keyframe).inverse() * graph.pose(b.old_keyframe);
  const Pose T_new_new = graph.pose(a.new_keyframe).inverse() * graph.pose(b.new_keyframe);
  const Pose difference = T_new_new.inverse() * a.T_old_new.inverse() * T_old_old * b.T_old_new;
  return difference.translation().norm() <= parameters_.agreement_m &&
         rotationAngle(difference) <= parameters_.agreement_rad;
}

std::vector<LoopCandidate> LoopVerdicts::offer(LoopCandidate& loop, double way_m, const PoseGraph& graph,
                                               int needed) {
  waiting_.erase(
      std::remove_if(waiting_.begin(), waiting_.end(),
                     [&](const Waiting& other) { return way_m - other.way_m > parameters_.agreement_way_m; }),
      waiting_.end());
  waiting_.push_back({loop, way_m, false});
  std::vector<Waiting*> agreeing;
  std::set<uint32_t> keyframes;
  for (Waiting& other : waiting_) {
    if (!agree(other.loop, loop, graph)) continue;
    agreeing.push_back(&other);
    keyframes.insert(other.loop.new_keyframe);
  }
  loop.agreeing = static_cast<int>(keyframes.size());
  if (loop.agreeing < needed) return {};
  const auto known = std::find_if(agreeing.begin(), agreeing.end(),
                                  [](const Waiting* other) { return other->is_confirmed; });
  loop.closure = known != agreeing.end() ? (*known)->loop.closure : closures_++;
  std::vector<LoopCandidate> confirmed;
  for (Waiting* other : agreeing) {
    if (std::exchange(other->is_confirmed, true)) continue;
    other->loop.agreeing = loop.agreeing;
    other->loop.closure = loop.closure;
    other->loop.verdict = LoopVerdict::kClosed;
    confirmed.push_back(other->loop);
  }
  return confirmed;
}

}  // namespace depth_fusion
