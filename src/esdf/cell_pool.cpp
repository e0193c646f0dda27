#include "esdf/cell_pool.h"

#include <algorithm>
#include <cstdint>

#include "esdf/types.h"

namespace depth_fusion {
namespace {

constexpr size_t kFirstBlocks = 256;

}  // namespace

void ensureBytes(ComputeContext& compute, DeviceBuffer& buffer, size_t bytes, const char* purpose) {
  if (buffer.bytes() < bytes) buffer = DeviceBuffer(compute, bytes + bytes / 4, purpose);
}

int CellPool::find(const BlockIndex& block) const {
  const auto found = slots_.find(block);
  return found == slots_.end() ? -1 : found->second;
}

int CellPool::findOrMake(const BlockIndex& block) {
  const auto found = slots_.find(block);
  if (found != slots_.end()) return found->second;
  if (slots_.size() == max_blocks_) return -1;
  if (slots_.size() == capacity_) grow();
  const int slot = static_cast<int>(slots_.size());
  slots_.emplace(block, slot);
  return slot;
}

void CellPool::forgetAll() {
  slots_.clear();
  capacity_ = 0;
  sites_ = DeviceBuffer();
  middles_ = DeviceBuffer();
  seen_ = DeviceBuffer();
}

void CellPool::grow() {
  capacity_ = std::min(std::max(2 * capacity_, kFirstBlocks), max_blocks_);
  const auto grown = [&](DeviceBuffer& buffer, size_t bytes_per_cell, int clear, const char* purpose) {
    DeviceBuffer larger(compute_, capacity_ * ESDF_CELLS * bytes_per_cell, purpose);
    larger.fill(clear, larger.bytes());
    if (buffer.bytes() > 0) larger.copyFrom(buffer, buffer.bytes());
    buffer = std::move(larger);
  };
  grown(sites_, sizeof(uint32_t), ESDF_NO_SITE, "the sites of cells");
  grown(middles_, 1, kAllChi, "the distances of cells");
  grown(seen_, 1, 0, "what is seen of cells");
}

}  // namespace depth_fusion
