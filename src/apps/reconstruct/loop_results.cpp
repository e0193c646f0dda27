#include "apps/reconstruct/loop_results.h"

#include <algorithm>
#include <map>
#include <utility>

#include "depth_fusion/recording/trajectory_file.h"

namespace depth_fusion {
namespace {

constexpr char kTableHead[] = "old keyframe,new keyframe,verdict,in words\n";

// Of each pair of keyframes the last that was said.
std::string tableOf(const std::vector<LoopCandidate>& candidates, size_t& closed) {
  std::map<std::pair<uint32_t, uint32_t>, const LoopCandidate*> pairs;
  for (const LoopCandidate& candidate : candidates)
    pairs[{candidate.new_keyframe, candidate.old_keyframe}] = &candidate;
  std::string table = kTableHead;
  for (const auto& [pair, candidate] : pairs) {
    table += std::to_string(pair.second) + "," + std::to_string(pair.first) + "," +
             nameOf(candidate->verdict) + ",\"" + candidate->text() + "\"\n";
    if (candidate->verdict == LoopVerdict::kClosed) ++closed;
  }
  return table;
}

}  // namespace

LoopResults resultsOf(LoopClosing& loops, const Trajectory& tracked) {
  loops.finish();
  LoopResults results;
  results.table = tableOf(loops.takeCandidates(), results.closed);
  results.keyframes = loops.keyframes();
  results.joins_parts = loops.joinsParts();
  const Corrections corrections = loops.corrections();
  for (const StampedPose& pose : tracked) {
    const Pose T_W_D = corrections.corrected(pose);
    results.moved_m = std::max(results.moved_m, (T_W_D.translation() - pose.T_W_D.translation()).norm());
    results.corrected.push_back({pose.stamp_s, T_W_D});
  }
  return results;
}

Keyframes movedTo(const Trajectory& trajectory, const Keyframes& keyframes) {
  Keyframes moved;
  for (const KeyframePtr& keyframe : keyframes) {
    if (const std::optional<Pose> T_W_D = poseAt(trajectory, keyframe->stamp_s, 0.0))
      moved.push_back(movedTo(*T_W_D, *keyframe));
  }
  return moved;
}

}  // namespace depth_fusion
