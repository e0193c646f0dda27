// The distance field of a map, kept up to date as the map changes: what is occupied comes from the map's
// surface, what is free from depth images, for of free space a map keeps nothing.
#pragma once

#include <map>
#include <memory>
#include <opencv2/core.hpp>
#include <set>
#include <string>
#include <vector>

#include "depth_fusion/common/stage_timers.h"
#include "depth_fusion/esdf/esdf_grid.h"
#include "depth_fusion/esdf/esdf_parameters.h"
#include "depth_fusion/frames/depth_frame.h"
#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/map/blocks_elsewhere.h"

namespace depth_fusion {

class CellLists;
class CellPool;
class DistanceField;
class EsdfKernels;
class FreeSpaceView;

// For one thread. What is known does not depend on when update() is called, and distances are those that
// computing all of them anew gives, bit for bit.
class Esdf {
 public:
  // Keeps references. `compute` is a queue of its own (ComputeContext::anotherQueue) where others work on the
  // map. Throws Error for parameters that do not fit.
  Esdf(ComputeContext& compute, BlockMap& map, const EsdfParameters& parameters);
  ~Esdf();

  // Whatever of the surface is elsewhere is read from there.
  void lookElsewhere(std::unique_ptr<BlocksElsewhere> elsewhere) { elsewhere_ = std::move(elsewhere); }
  // Reads what has changed in the map since the last call. After a reset of the map all is forgotten; returns
  // whether it was. Whoever calls it holds what guards the map, of which nothing is at work any more.
  bool readMap(StageTimers& timers);
  // A depth image shows free space from T_W_D: a frame, or one in metres (CV_32FC1, 0 = none) without noise.
  void see(const DepthFrame& frame, const Pose& T_W_D, StageTimers& timers);
  void see(const cv::Mat& depth_m, const CameraIntrinsics& camera, const Pose& T_W_D);
  // Computes the distances that may be others than at the last call. Returns the blocks of cells that it has
  // looked at.
  std::vector<BlockIndex> update(StageTimers& timers);
  // The next update computes all distances.
  void computeAll();

  // As of the last update.
  const EsdfGrid& grid() const { return grid_; }
  // Why something is left out; empty if all is well.
  const std::string& problem() const { return problem_; }

 private:
  void forgetAll();
  BlockIndex blockOf(const BlockIndex& of_map) const;
  BlockBox boxOf(const BlockIndex& block) const;
  // The surface of the blocks of cells is to be read that these blocks of the map lie in.
  void noteStale(const std::vector<BlockIndex>& of_map);
  // Reads the surface of the listed blocks of cells anew, from a map that has it.
  void readSurface(BlockMap& map, const std::vector<BlockIndex>& blocks);
  void see(const DeviceBuffer& depth, const FreeSpaceView& view);
  // As kernels list them, an entry a block.
  void noteChanges(const std::vector<BlockIndex>& blocks, const std::vector<int>& changes);
  // The blocks with distances that may have changed.
  std::vector<BlockIndex> dirtyBlocks() const;

  using BlockSet = std::set<BlockIndex, BlockOrder>;

  ComputeContext& compute_;
  BlockMap& map_;
  EsdfParameters parameters_;
  MapSubscription changes_;
  uint32_t generation_ = 0;
  int blocks_per_axis_;  // of the map, in a block of cells
  std::unique_ptr<BlocksElsewhere> elsewhere_;
  std::unique_ptr<EsdfKernels> kernels_;
  std::unique_ptr<CellPool> cells_;
  std::unique_ptr<CellLists> lists_;
  std::unique_ptr<DistanceField> field_;
  EsdfGrid grid_;
  std::map<BlockIndex, float, BlockOrder>
      reach_;                               // of the sites that a block's distances depend on, in cells
  BlockSet stale_;                          // their surface is to be read
  BlockSet known_changed_, sites_changed_;  // since the last update
  std::string problem_;
};

}  // namespace depth_fusion
