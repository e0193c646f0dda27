// A map once more, from what its keyframes show where they are known to be by now. Poses move, voxels do not:
// nothing is taken out of a map again.
#pragma once

#include <memory>

#include "depth_fusion/pipeline/mapper.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"
#include "depth_fusion/relocalisation/keyframe.h"
#include "depth_fusion/submaps/map_file.h"

namespace depth_fusion {

// What a keyframe shows, as a frame: its view, and its colour if it has one.
RgbdFrame frameOf(const Keyframe& keyframe);
// How frames are preprocessed that are views: they are smooth, of one moment, and free of the sensor's
// systematic errors.
PreprocessingParameters ofViews(PreprocessingParameters parameters);

class MapRefinement {
 public:
  // The parameters are those of the new map; its voxels may be smaller than those that the keyframes saw.
  MapRefinement(ComputeContext& compute, const PipelineParameters& parameters);

  // Fuses the view of the keyframe, and its colour; whoever calls it takes the keyframes in the order of
  // time. One without a view shows nothing. Throws Error if the device fails.
  void fuse(const Keyframe& keyframe, const Pose& T_W_D);

  SubmapCollection& submaps() { return submaps_; }
  // Saves the map, as one of a sensor's with that camera. Throws Error if it cannot be written.
  SaveReport save(MapSaver& saver, const CameraIntrinsics& camera, const StampedPose& last_pose,
                  const Keyframes& keyframes);

 private:
  ComputeContext& compute_;
  PipelineParameters parameters_;
  BlockMap map_;
  SubmapCollection submaps_;
  CameraIntrinsics camera_;  // of the views
  std::unique_ptr<DepthPreprocessor> preprocessor_;
  std::unique_ptr<Mapper> mapper_;
};

}  // namespace depth_fusion
