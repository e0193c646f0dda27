// Loops: keyframes come in, and what they make of the poses of all of them goes out.
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "depth_fusion/loops/corrections.h"
#include "depth_fusion/loops/loop_candidate.h"
#include "depth_fusion/loops/loop_finder.h"
#include "depth_fusion/loops/loop_verdicts.h"
#include "depth_fusion/loops/loop_verifier.h"
#include "depth_fusion/loops/pose_graph.h"
#include "depth_fusion/relocalisation/keyframe.h"

namespace depth_fusion {

class GraphWays;

// How a keyframe lies to the one before it.
struct KeyframeMotion {
  Pose T_previous_current = Pose::Identity();  // as it was tracked
  Matrix6d covariance = Matrix6d::Zero();      // beside drift; of the twist on the left
};

// What came of a keyframe.
struct LoopReport {
  uint32_t number = 0;                    // of the keyframe
  std::vector<LoopCandidate> candidates;  // its own, and older ones whose verdict changed
  bool poses_changed = false;
  GraphChange change;
  double find_ms = 0.0, verify_ms = 0.0, solve_ms = 0.0;
};

// It works where it is called; whoever owns it owns the thread, too. Nothing here is synchronised.
class LoopCloser {
 public:
  // Gives back the keyframe of a number, which was given to add(); from where its owner keeps it.
  using LoadKeyframe = std::function<KeyframePtr(uint32_t number)>;

  // Without `load` all keyframes are kept here.
  explicit LoopCloser(const LoopParameters& parameters, LoadKeyframe load = {});

  // Takes in a keyframe with its view and way, which grows from one to the next. Without a motion nothing is
  // known of how it lies to the one before: a map that begins anew, another session, another robot. `down_D`:
  // the direction of gravity in its frame, if it was measured.
  LoopReport add(KeyframePtr keyframe, const std::optional<KeyframeMotion>& motion,
                 const std::optional<Eigen::Vector3d>& down_D = std::nullopt);

  // Of all keyframes, in the order in which they came.
  Corrections corrections() const;
  // Where the keyframe is, by all that is known.
  const Pose& pose(uint32_t number) const { return graph_.pose(number); }
  const PoseGraph& graph() const { return graph_; }
  // The graph and the index, without the keyframes.
  size_t bytes() const;

 private:
  // What there is of a keyframe beside the graph and the index.
  struct Known {
    KeyframePtr keyframe;  // null where it is loaded
    double stamp_s = 0.0;
    double way_m = 0.0;
    Pose T_W_then = Pose::Identity();
    uint32_t stretch = 0;  // as CorrectedKeyframe has it
  };

  KeyframePtr keyframe(uint32_t number) const;
  // Those that look alike, the best of each stretch of way.
  std::vector<LoopCandidate> find(const Keyframe& keyframe, uint32_t number, const GraphWays& ways) const;
  // Judges those in reach, the most alike first, and returns the ones that fit.
  std::vector<size_t> judge(const Keyframe& keyframe, const GraphWays& ways,
                            std::vector<LoopCandidate>& candidates) const;
  bool isInReach(const GraphWays& ways, LoopCandidate& loop) const;
  bool isWithinDrift(const GraphWays& ways, LoopCandidate& loop) const;
  // Places that fit and cannot be the same one.
  bool areAmbiguous(const std::vector<LoopCandidate>& candidates, const std::vector<size_t>& fitting) const;
  void close(const std::vector<LoopCandidate>& confirmed, LoopReport& report);
  void setVerdict(uint32_t closure, LoopVerdict verdict, LoopReport& report);

  LoopParameters parameters_;
  LoadKeyframe load_;
  LoopFinder finder_;
  LoopVerifier verifier_;
  LoopVerdicts verdicts_;
  PoseGraph graph_;
  std::vector<Known> known_;
  std::vector<LoopCandidate> closed_;  // and those that were
};

}  // namespace depth_fusion
