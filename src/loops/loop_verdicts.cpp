#include "depth_fusion/loops/loop_verdicts.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "loops/graph_way.h"

namespace depth_fusion {
namespace {

constexpr double kAgreement_sigmas = 3.0;
constexpr double kMostApart = 3.0;  // times the tolerance, whatever drift may do

}  // namespace

// The way between the new keyframes, over the two loops and the way between the old ones, is what was
// tracked: within the tolerance, or within what drift does to the two ways.
bool LoopVerdicts::agree(const LoopCandidate& a, const LoopCandidate& b, const PoseGraph& graph) const {
  const Pose T_old_old = graph.pose(a.old_keyframe).inverse() * graph.pose(b.old_keyframe);
  const Pose T_new_new = graph.pose(a.new_keyframe).inverse() * graph.pose(b.new_keyframe);
  const Pose over_loops = a.T_old_new.inverse() * T_old_old * b.T_old_new;
  const Pose difference = T_new_new.inverse() * over_loops;
  const double apart = std::max(difference.translation().norm() / parameters_.agreement_m,
                                rotationAngle(difference) / parameters_.agreement_rad);
  if (apart <= 1.0) return true;
  if (apart > kMostApart) return false;
  const std::optional<GraphRelation> old_way = GraphWays(graph, b.old_keyframe).relationFrom(a.old_keyframe);
  const std::optional<GraphRelation> new_way = GraphWays(graph, b.new_keyframe).relationFrom(a.new_keyframe);
  if (!old_way || !new_way) return false;
  const Matrix6d to_b = adjoint(T_old_old), to_new = adjoint(a.T_old_new.inverse());
  const Matrix6d about_old = a.covariance + old_way->covariance + to_b * b.covariance * to_b.transpose();
  const Matrix6d covariance = to_new * about_old * to_new.transpose() + new_way->covariance;
  const Vector6d twist = twistFromPose(over_loops * T_new_new.inverse());
  return twist.dot(covariance.ldlt().solve(twist)) <= kAgreement_sigmas * kAgreement_sigmas;
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
