// Model view: depth and normals of the map as a camera sees it (the paper's section "Scene Rendering").
#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "depth_fusion/common/stage_timers.h"
#include "depth_fusion/compute/result_pool.h"
#include "depth_fusion/frames/model_view.h"
#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/map/block_map.h"
#include "depth_fusion/model_view/model_view_parameters.h"

namespace depth_fusion {

class MeshRenderer;

class ModelViewRenderer {
 public:
  class Kernels;  // typed launches, private to the library and its tests

  // Views are as large as the camera's images, or half as large in each axis if the parameters say so.
  ModelViewRenderer(ComputeContext& compute, BlockMap& map, const CameraIntrinsics& camera,
                    ModelViewParameters parameters = {});
  ~ModelViewRenderer();

  // The map between min_range_m and max_range_m, as the parameters say how. The result stays valid until the
  // next call.
  const ModelView& render(const Pose& T_W_D, float min_range_m, float max_range_m, StageTimers& timers);
  // The last result, valid and unchanged for as long as it is held.
  std::shared_ptr<const ModelView> view() const { return views_.current(); }

  // Pictures of the last view, CV_8UC3 BGR: grey and lit from the camera; in the map's colours, grey where it
  // has none.
  cv::Mat shadedPicture();
  // Throws Error if the map holds no colour.
  cv::Mat coloredPicture();

 private:
  void allocatePicture();
  cv::Mat readPicture() const;

  ComputeContext& compute_;
  BlockMap& map_;
  CameraIntrinsics camera_;  // of the views
  ResultPool<ModelView> views_;
  DeviceBuffer nearest_, occupied_;  // ranges of the rays
  DeviceBuffer picture_;             // allocated for the first one
  std::unique_ptr<Kernels> kernels_;
  std::unique_ptr<MeshRenderer> mesh_renderer_;  // null for ray casting
};

}  // namespace depth_fusion
