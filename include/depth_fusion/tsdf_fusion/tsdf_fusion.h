// TSDF fusion: block selection and integration of one depth frame at a known pose.
#pragma once

#include <memory>

#include "depth_fusion/common/parameters.h"
#include "depth_fusion/common/stage_timers.h"
#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/map/block_sparse_map.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"

namespace depth_fusion {

struct FusionParameters {
  std::string rule = "kalman";
  std::string distance = "plane";
  float gain_at_1m = 0.02f;
  float weight_at_1m = 4.0f;
  float max_weight = 255.0f;
  float process_sigma_m = 3e-5f;
  float free_space_sigmas = 2.0f;
  float free_space_rate = 0.4f;

  ParameterTable table();
};

struct FusionResult {
  size_t blocks_requested = 0;
  size_t blocks_allocated = 0;  // less than requested: the pool is full, and the frame fused what fits
  size_t blocks_updated = 0;
  size_t blocks_released = 0;
  size_t points_outside = 0;  // samples of the surface outside of the window: left out

  // The frame left something in the map.
  bool fused() const { return blocks_updated > 0; }
};

class TsdfFusion {
 public:
  class Kernels;  // typed launches, private to the library and its tests

  TsdfFusion(ComputeContext& compute, BlockSparseMap& map, const FusionParameters& parameters);
  ~TsdfFusion();

  // For the frames to come. Throws Error if rule or distance are others than before.
  void setParameters(const FusionParameters& parameters);

  // Fuses the frame's measurements, seen from T_W_D, into the map; allocates the blocks it needs and releases
  // those left empty.
  FusionResult integrate(const DepthFrame& frame, const Pose& T_W_D, StageTimers& timers);

  // Slots of the blocks that the last frame updated, FusionResult::blocks_updated of them.
  const DeviceBuffer& visibleBlocks() const { return visible_; }

 private:
  void allocateBlocks(const DepthFrame& frame, const Pose& T_W_D, FusionResult& result);

  ComputeContext& compute_;
  BlockSparseMap& map_;
  FusionParameters parameters_;
  DeviceBuffer requests_, visible_, empty_, count_, points_outside_;
  std::unique_ptr<Kernels> kernels_;
  int frame_number_ = 0;
};

}  // namespace depth_fusion
