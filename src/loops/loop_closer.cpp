#include "depth_fusion/loops/loop_closer.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "depth_fusion/common/error.h"
#include "loops/graph_way.h"
#include "loops/largest_sigma.h"

namespace depth_fusion {
namespace {

// So many times as many as are compared are looked up: some are out of reach, or beside better ones.
constexpr size_t kLookedUp = 12;

class Stopwatch {
 public:
  double ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin_).count();
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

// Of the difference between two motions, in standard deviations of both.
double sigmasBetween(const Pose& T_a_b, const Pose& other_T_a_b, const Matrix6d& covariance) {
  const Vector6d twist = twistFromPose(T_a_b * other_T_a_b.inverse());
  return std::sqrt(std::max(0.0, twist.dot(covariance.ldlt().solve(twist))));
}

bool isSameLoop(const LoopCandidate& a, const LoopCandidate& b) {
  return a.old_keyframe == b.old_keyframe && a.new_keyframe == b.new_keyframe;
}

}  // namespace

LoopCloser::LoopCloser(const LoopParameters& parameters, LoadKeyframe load)
    : parameters_(parameters),
      load_(std::move(load)),
      finder_(parameters.index_features),
      verifier_(parameters),
      verdicts_(parameters),
      graph_(parameters) {}

KeyframePtr LoopCloser::keyframe(uint32_t number) const {
  return load_ ? load_(number) : known_[number].keyframe;
}

LoopReport LoopCloser::add(KeyframePtr keyframe, const std::optional<KeyframeMotion>& motion,
                           const std::optional<Eigen::Vector3d>& down_D) {
  check(keyframe != nullptr, "a keyframe is missing");
  check(!motion || !known_.empty(), "the first keyframe has none before it");
  check(known_.empty() || keyframe->way_m >= known_.back().way_m,
        "a keyframe comes from farther back on the way than the one before");
  const Keyframe& added = *keyframe;
  LoopReport report;
  const Pose T_W_D = motion
                         ? graph_.pose(static_cast<uint32_t>(graph_.size() - 1)) * motion->T_previous_current
                         : added.T_W_D;
  report.number = graph_.addNode(T_W_D, down_D);
  if (motion) {
    const double way_m = std::max(0.0, added.way_m - known_.back().way_m);
    graph_.addWay(report.number - 1, report.number, motion->T_previous_current, way_m, motion->covariance);
  }
  const uint32_t stretch = motion ? known_.back().stretch : report.number;
  known_.push_back({load_ ? nullptr : keyframe, added.stamp_s, added.way_m, added.T_W_D, stretch});
  if (!added.features.reason.empty()) return report;

  const Stopwatch finding;
  const GraphWays ways(graph_, report.number);
  report.candidates = find(added, report.number, ways);
  finder_.add(report.number, added.features);
  report.find_ms = finding.ms();

  const Stopwatch verifying;
  const std::vector<size_t> fitting = judge(added, ways, report.candidates);
  const bool ambiguous = areAmbiguous(report.candidates, fitting);
  std::vector<LoopCandidate> confirmed, earlier;
  for (const size_t i : fitting) {
    LoopCandidate& loop = report.candidates[i];
    if (ambiguous) {
      loop.verdict = LoopVerdict::kAmbiguous;
      continue;
    }
    // Where nothing is known of how they lie, drift says nothing, and more have to.
    const int needed = parameters_.agreeing_loops * (ways.way_m(loop.old_keyframe) ? 1 : 2);
    for (LoopCandidate& other : verdicts_.offer(loop, added.way_m, graph_, needed)) {
      if (isSameLoop(other, loop))
        loop.verdict = LoopVerdict::kClosed;
      else
        earlier.push_back(other);
      confirmed.push_back(std::move(other));
    }
  }
  report.candidates.insert(report.candidates.end(), earlier.begin(), earlier.end());
  report.verify_ms = verifying.ms();
  if (!confirmed.empty()) close(confirmed, report);
  return report;
}

std::vector<LoopCandidate> LoopCloser::find(const Keyframe& keyframe, uint32_t number,
                                            const GraphWays& ways) const {
  const auto isEligible = [&](uint32_t other) {
    const std::optional<double> way_m = ways.way_m(other);
    return !way_m || *way_m >= parameters_.min_way_m;
  };
  const size_t count = kLookedUp * static_cast<size_t>(parameters_.max_candidates);
  std::vector<LoopCandidate> candidates;
  for (const AlikeKeyframe& alike : finder_.find(keyframe.features, isEligible, count)) {
    const bool is_beside =
        std::any_of(candidates.begin(), candidates.end(), [&](const LoopCandidate& better) {
          return std::abs(known_[better.old_keyframe].way_m - known_[alike.number].way_m) <
                 parameters_.candidate_spacing_m;
        });
    if (is_beside) continue;
    LoopCandidate loop;
    loop.old_keyframe = alike.number;
    loop.new_keyframe = number;
    loop.likeness = alike.likeness;
    candidates.push_back(loop);
  }
  return candidates;
}

std::vector<size_t> LoopCloser::judge(const Keyframe& added, const GraphWays& ways,
                                      std::vector<LoopCandidate>& candidates) const {
  std::vector<size_t> fitting;
  int compared = 0;
  size_t judged = 0;
  for (; judged < candidates.size() && compared < parameters_.max_candidates; ++judged) {
    LoopCandidate& loop = candidates[judged];
    if (!isInReach(ways, loop)) continue;
    ++compared;
    const KeyframePtr old_keyframe = keyframe(loop.old_keyframe);
    if (old_keyframe == nullptr) {
      loop.verdict = LoopVerdict::kNoView;
      continue;
    }
    if (verifier_.verify(*old_keyframe, added, loop) && isWithinDrift(ways, loop)) fitting.push_back(judged);
  }
  candidates.resize(judged);
  return fitting;
}

bool LoopCloser::isInReach(const GraphWays& ways, LoopCandidate& loop) const {
  const std::optional<GraphRelation> relation = ways.relationFrom(loop.old_keyframe);
  if (!relation) return true;
  loop.apart_m = relation->T_a_b.translation().norm();
  loop.way_m = relation->way_m;
  const Matrix6d to_new = adjoint(relation->T_a_b.inverse());
  const Matrix6d about_new = to_new * relation->covariance * to_new.transpose();
  const double sigma_m = largestSigma(about_new.bottomRightCorner<3, 3>());
  if (loop.apart_m <= parameters_.reach_m + parameters_.max_drift_sigmas * sigma_m) return true;
  loop.verdict = LoopVerdict::kOutOfReach;
  return false;
}

bool LoopCloser::isWithinDrift(const GraphWays& ways, LoopCandidate& loop) const {
  const std::optional<GraphRelation> relation = ways.relationFrom(loop.old_keyframe);
  if (!relation) return true;
  loop.drift_sigmas = sigmasBetween(loop.T_old_new, relation->T_a_b, relation->covariance + loop.covariance);
  if (loop.drift_sigmas <= parameters_.max_drift_sigmas) return true;
  loop.verdict = LoopVerdict::kBeyondDrift;
  return false;
}

bool LoopCloser::areAmbiguous(const std::vector<LoopCandidate>& candidates,
                              const std::vector<size_t>& fitting) const {
  for (size_t i = 1; i < fitting.size(); ++i) {
    const LoopCandidate& a = candidates[fitting.front()];
    const LoopCandidate& b = candidates[fitting[i]];
    const std::optional<GraphRelation> relation =
        GraphWays(graph_, b.old_keyframe).relationFrom(a.old_keyframe);
    if (!relation) continue;
    const Pose T_old_old = a.T_old_new * b.T_old_new.inverse();
    const Matrix6d to_a = adjoint(T_old_old);
    const Matrix6d covariance = relation->covariance + a.covariance + to_a * b.covariance * to_a.transpose();
    if (sigmasBetween(T_old_old, relation->T_a_b, covariance) > parameters_.max_drift_sigmas) return true;
  }
  return false;
}

void LoopCloser::close(const std::vector<LoopCandidate>& confirmed, LoopReport& report) {
  const Stopwatch solving;
  for (const LoopCandidate& loop : confirmed) {
    graph_.addLoop(loop.old_keyframe, loop.new_keyframe, loop.T_old_new, loop.covariance, loop.closure);
    closed_.push_back(loop);
  }
  report.change = graph_.solve();
  report.poses_changed = true;
  for (const uint32_t closure : report.change.undone) setVerdict(closure, LoopVerdict::kUndone, report);
  for (const uint32_t closure : report.change.restored) setVerdict(closure, LoopVerdict::kClosed, report);
  report.solve_ms = solving.ms();
}

void LoopCloser::setVerdict(uint32_t closure, LoopVerdict verdict, LoopReport& report) {
  for (LoopCandidate& loop : closed_) {
    if (loop.closure != closure) continue;
    loop.verdict = verdict;
    const auto said = std::find_if(report.candidates.begin(), report.candidates.end(),
                                   [&](const LoopCandidate& other) { return isSameLoop(loop, other); });
    if (said != report.candidates.end())
      said->verdict = verdict;
    else
      report.candidates.push_back(loop);
  }
}

Corrections LoopCloser::corrections() const {
  const std::vector<uint32_t> parts = graph_.parts();
  std::vector<CorrectedKeyframe> keyframes;
  for (uint32_t number = 0; number < known_.size(); ++number) {
    const Known& known = known_[number];
    keyframes.push_back({known.stamp_s, known.T_W_then, graph_.pose(number), known.stretch, parts[number]});
  }
  return Corrections(std::move(keyframes));
}

size_t LoopCloser::bytes() const {
  return finder_.bytes() + graph_.bytes() + known_.capacity() * sizeof(Known) +
         closed_.capacity() * sizeof(closed_.front());
}

}  // namespace depth_fusion
