// Where one map shows what another one shows, too.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "depth_fusion/icp_tracking/icp_tracker.h"
#include "depth_fusion/loops/loop_finder.h"
#include "depth_fusion/loops/loop_verifier.h"
#include "depth_fusion/pipeline/map_merging.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"
#include "pipeline/open_map.h"

namespace depth_fusion {

// A keyframe of the second map that fits the first one.
struct Fit {
  Pose T_B_D, T_A_B;
};

// Finds places of the first map for keyframes of the second.
class OverlapSearch {
 public:
  // Keeps references.
  OverlapSearch(ComputeContext& compute, OpenMap& first);

  // The fit of a keyframe with its view, with the place that looks most like it of those that fit.
  std::optional<Fit> fit(const Keyframe& keyframe);

 private:
  const Keyframe& seen(uint32_t number);
  // Where the keyframe's view lies on the first map by ICP; as it was guessed, if that says nothing.
  Pose aligned(const Keyframe& keyframe, const Pose& T_A_D);

  ComputeContext& compute_;
  OpenMap& first_;
  const LoopParameters loops_;
  const LoopVerifier verifier_;
  LoopFinder finder_;
  std::vector<std::optional<Keyframe>> seen_;  // of the first map, as far as they were needed
  CameraIntrinsics camera_;
  std::unique_ptr<DepthPreprocessor> preprocessor_;
  std::unique_ptr<IcpTracker> tracker_;
};

// What most of them agree on; without agreeing ones for none.
MapOverlap overlapOf(const std::vector<Fit>& fits, const LoopParameters& loops);
// Throws Error unless enough agree, and hardly any says something else.
void checkOverlap(const MapOverlap& overlap, const LoopParameters& loops, const OpenMap& first,
                  const OpenMap& second);

}  // namespace depth_fusion
