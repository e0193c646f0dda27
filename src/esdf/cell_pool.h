// What is known of cells, on the device, by blocks of 16^3.
#pragma once

#include <map>

#include "depth_fusion/compute/device_buffer.h"
#include "depth_fusion/map/block_index.h"

namespace depth_fusion {

// Four distance bytes of TSDF_CHI.
constexpr int kAllChi = static_cast<int>(0x80808080u);

// Blocks come, and stay until all go. The memory grows with them.
class CellPool {
 public:
  CellPool(ComputeContext& compute, size_t max_blocks) : compute_(compute), max_blocks_(max_blocks) {}

  // The block's slot; -1 if there is none.
  int find(const BlockIndex& block) const;
  // Its slot; a block that is new has neither sites nor anything known. -1 if there is no room.
  int findOrMake(const BlockIndex& block);
  void forgetAll();
  const std::map<BlockIndex, int, BlockOrder>& slots() const { return slots_; }

  DeviceBuffer& sites() { return sites_; }  // kernels/shared/types.h
  const DeviceBuffer& sites() const { return sites_; }
  DeviceBuffer& middles() { return middles_; }  // distance bytes, TSDF_CHI = not known
  const DeviceBuffer& middles() const { return middles_; }
  DeviceBuffer& seen() { return seen_; }  // how often each was seen to be free
  const DeviceBuffer& seen() const { return seen_; }

 private:
  void grow();

  ComputeContext& compute_;
  size_t max_blocks_, capacity_ = 0;
  std::map<BlockIndex, int, BlockOrder> slots_;
  DeviceBuffer sites_, middles_, seen_;
};

// A buffer of a size that was needed once; its contents are lost where it grows.
void ensureBytes(ComputeContext& compute, DeviceBuffer& buffer, size_t bytes, const char* purpose);

}  // namespace depth_fusion
