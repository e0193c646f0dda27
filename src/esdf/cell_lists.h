// Lists of blocks of cells, for the kernels that change what is known of them.
#pragma once

#include <vector>

#include "esdf/esdf_kernels.h"
#include "esdf/free_space_view.h"

namespace depth_fusion {

class CellLists {
 public:
  // Keeps references.
  CellLists(ComputeContext& compute, EsdfKernels& kernels) : compute_(compute), kernels_(kernels) {}

  // Reads the surface of the blocks of cells with these slots anew, from the map's blocks in map_slots, each
  // of which lies in the block of cells at its place in the list. These two return what has changed in each
  // block of cells, as ESDF_* bits.
  std::vector<int> read(BlockMap& map, const std::vector<int>& map_slots, const std::vector<int>& places,
                        const std::vector<int>& cell_slots, CellPool& cells);
  // Counts the cells that are seen to be free in these blocks, which have these slots.
  std::vector<int> see(const DeviceBuffer& depth, const FreeSpaceView& view,
                       const std::vector<BlockIndex>& blocks, const std::vector<int>& slots, CellPool& cells);

 private:
  void beginChanges(size_t blocks);

  ComputeContext& compute_;
  EsdfKernels& kernels_;
  DeviceBuffer map_slots_, places_, cell_slots_, blocks_, changes_, sites_, middles_;
};

}  // namespace depth_fusion
