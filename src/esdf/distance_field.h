// Distances of blocks of cells, region by region.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "depth_fusion/map/slot_table.h"
#include "esdf/esdf_kernels.h"

namespace depth_fusion {

class DistanceField {
 public:
  // Keeps references.
  DistanceField(ComputeContext& compute, EsdfKernels& kernels, const CellPool& cells)
      : compute_(compute), kernels_(kernels), cells_(cells) {}

  // Is given a block's cells, a word each, as nearest_along_x has it.
  using Take = std::function<void(const BlockIndex& block, const int32_t* cells)>;
  // Computes the blocks, which the pool has. Far apart they are computed one after the other, for the memory
  // is that of the box about those computed together.
  void compute(const std::vector<BlockIndex>& blocks, const Take& take);

 private:
  void computeTogether(const std::vector<BlockIndex>& blocks, const BlockBox& box, const Take& take);
  void uploadSlots(const BlockBox& region);

  ComputeContext& compute_;
  EsdfKernels& kernels_;
  const CellPool& cells_;
  DeviceBuffer slots_, along_z_, planes_, blocks_, results_;
};

}  // namespace depth_fusion
