// Typed launches of kernels/esdf/*.cl.
#pragma once

#include "compute/kernel.h"
#include "depth_fusion/esdf/esdf_parameters.h"
#include "depth_fusion/map/block_map.h"
#include "esdf/cell_pool.h"
#include "esdf/free_space_view.h"
#include "esdf/types.h"

namespace depth_fusion {

// Throws Error for parameters that do not fit the map.
EsdfArgs esdfArgs(const EsdfParameters& parameters, const MapParameters& map);

class EsdfKernels {
 public:
  EsdfKernels(ComputeContext& compute, const MapParameters& map, const EsdfArgs& args);

  const EsdfArgs& args() const { return args_; }
  // The surface of `count` of the map's blocks, into a list of blocks of cells.
  void readSurface(BlockMap& map, const DeviceBuffer& slots, const DeviceBuffer& places, int count,
                   DeviceBuffer& sites, DeviceBuffer& middles);
  // A list of `count` blocks of cells into the pool.
  void adoptSurface(const DeviceBuffer& new_sites, const DeviceBuffer& new_middles, const DeviceBuffer& slots,
                    int count, CellPool& cells, DeviceBuffer& changes);
  // Counts the cells of `count` blocks, which are listed with their slots.
  void seeFree(const DeviceBuffer& depth, const FreeSpaceView& view, const DeviceBuffer& blocks, int count,
               CellPool& cells, DeviceBuffer& changes);
  // The three passes of the distance transform; the first two fill what the next one reads.
  void nearestAlongZ(const DeviceBuffer& slots, const CellPool& cells, DeviceBuffer& along_z,
                     const EsdfRegionArgs& region);
  void nearestAlongY(const DeviceBuffer& along_z, DeviceBuffer& planes, const EsdfRegionArgs& region);
  void nearestAlongX(const DeviceBuffer& slots, const CellPool& cells, const DeviceBuffer& planes,
                     const DeviceBuffer& blocks, int count, DeviceBuffer& results,
                     const EsdfRegionArgs& region);

 private:
  int simd_width_;
  EsdfArgs args_;
  Kernel read_, adopt_, see_, along_z_, along_y_, along_x_;
};

}  // namespace depth_fusion
