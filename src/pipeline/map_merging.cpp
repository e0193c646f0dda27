#include "depth_fusion/pipeline/map_merging.h"

#include <algorithm>

#include "depth_fusion/pipeline/map_refinement.h"
#include "pipeline/map_overlap.h"
#include "pipeline/open_map.h"

namespace depth_fusion {

MergedMaps mergeMaps(ComputeContext& compute, const PipelineParameters& parameters, Database& first,
                     Database& second, MapSaver& saver, const std::function<void(double)>& progress) {
  const auto say = [&](double done) {
    if (progress) progress(done);
  };
  MergedMaps merged;
  OpenMap second_map(compute, parameters, second);
  const Keyframes& keyframes_B = second_map.loaded().keyframes;
  const double steps = 2.0 * static_cast<double>(std::max<size_t>(keyframes_B.size(), 1));
  double done = 0.0;
  Keyframes keyframes;
  PipelineParameters of_first;
  {
    OpenMap first_map(compute, parameters, first);
    OverlapSearch search(compute, first_map);
    std::vector<Fit> fits;
    for (const KeyframePtr& keyframe : keyframes_B) {
      if (const std::optional<Fit> fit = search.fit(second_map.seen(*keyframe))) fits.push_back(*fit);
      say(++done / steps);
    }
    of_first = first_map.parameters();
    merged.overlap = overlapOf(fits, of_first.loops);
    checkOverlap(merged.overlap, of_first.loops, first_map, second_map);
    keyframes = first_map.loaded().keyframes;
  }
  MapRefinement result(compute, of_first);
  ReadMap(first, result.submaps()).moveTo(result.submaps());
  const Pose& T_A_B = merged.overlap.T_A_B;
  for (const KeyframePtr& keyframe : keyframes_B) {
    result.fuse(second_map.seen(*keyframe), T_A_B * keyframe->T_W_D);
    say(++done / steps);
  }
  for (const KeyframePtr& keyframe : keyframes_B)
    keyframes.push_back(movedTo(orthonormalized(T_A_B * keyframe->T_W_D), *keyframe));
  StampedPose last_pose = second_map.loaded().description.last_pose;
  last_pose.T_W_D = orthonormalized(T_A_B * last_pose.T_W_D);
  merged.saved = result.save(saver, second_map.loaded().description.camera, last_pose, keyframes);
  return merged;
}

}  // namespace depth_fusion
