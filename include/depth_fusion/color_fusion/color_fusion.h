// Colour fusion: the colour image of a frame, into the voxels of the map near the surface.
#pragma once

#include <memory>
#include <string>

#include "depth_fusion/color_fusion/color_fusion_parameters.h"
#include "depth_fusion/common/stage_timers.h"
#include "depth_fusion/frames/depth_frame.h"
#include "depth_fusion/frames/mapping_result.h"
#include "depth_fusion/frames/rgbd_frame.h"
#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/map/block_map.h"

namespace depth_fusion {

struct SurfaceColor;

class ColorFusion {
 public:
  class Kernels;  // typed launches, private to the library and its tests

  // The stage for the map; null for a map without colour.
  static std::unique_ptr<ColorFusion> create(ComputeContext& compute, BlockMap& map,
                                             const ColorFusionParameters& parameters);
  // Throws Error for a map without colour.
  ColorFusion(ComputeContext& compute, BlockMap& map, const ColorFusionParameters& parameters);
  ~ColorFusion();

  // The parameters are for the frames to come.
  void setParameters(const ColorFusionParameters& parameters);

  // Fuses the frame's colour, after its depth, into the first visible_count of the visible blocks. A frame
  // without a colour image that fits its camera changes nothing.
  ColorFusionResult integrate(const RgbdFrame& frame, const DepthFrame& depth, const Pose& T_W_D,
                              const DeviceBuffer& visible, size_t visible_count, StageTimers& timers);

 private:
  struct Images;

  // The aligned pose, drawn a little towards the one that geometry gives as long as it stays on one side of
  // that: clocks that differ move it to and fro, but small errors of calibration add up as the view moves on.
  Pose anchored(const Pose& aligned_T_C_W, const Pose& T_C_W);
  // 1 for the sharpest image of late, less for blurred ones.
  double sharpnessWeight(const cv::Mat& color);
  // What the map says about the surface that the depth shows.
  std::vector<SurfaceColor> sampleMap(const DepthFrame& depth, const Pose& T_W_D);

  ComputeContext& compute_;
  BlockMap& map_;
  ColorFusionParameters parameters_;
  std::unique_ptr<Kernels> kernels_;
  std::unique_ptr<Images> images_;  // null before the first colour image
  DeviceBuffer points_, found_;
  Eigen::Array3d exposure_gain_ = Eigen::Array3d::Ones();  // of the last frame
  Vector6d mean_correction_ = Vector6d::Zero();            // by alignment, of late
  double sharpest_ = 0.0;                                  // image of late
  int frame_number_ = 0;
};

}  // namespace depth_fusion
