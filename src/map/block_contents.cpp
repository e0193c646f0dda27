// What is in a map's blocks, between the device and the host.
#include <algorithm>

#include "depth_fusion/common/error.h"
#include "depth_fusion/map/block_map.h"
#include "map/map_kernels.h"

namespace depth_fusion {
namespace {

constexpr size_t kBlockTransferBytes = size_t{4} << 20;  // of blocks that are copied at a time

}  // namespace

template <class Function>
void BlockMap::forEachTransfer(const std::string& name, const std::vector<int>& slots,
                               const Function& function) {
  if (block_transfer_.bytes() == 0)
    block_transfer_ = DeviceBuffer(compute_, kBlockTransferBytes, "blocks that come or go");
  BlockLayer& layer = layerNamed(name);
  const size_t bytes = layer.row().bytesPerBlock(parameters_.block_size);
  const size_t blocks = std::min(kBlockTransferBytes / bytes, slot_transfer_.bytes() / sizeof(int));
  for (size_t begin = 0; begin < slots.size(); begin += blocks) {
    const size_t count = std::min(blocks, slots.size() - begin);
    slot_transfer_.write(slots.data() + begin, count * sizeof(int));
    function(layer, static_cast<int>(count), begin * bytes, count * bytes);
  }
}

std::string BlockMap::voxels(const std::string& name, const std::vector<int>& slots) {
  std::string voxels(slots.size() * layerNamed(name).row().bytesPerBlock(parameters_.block_size), '\0');
  forEachTransfer(name, slots, [&](BlockLayer& layer, int count, size_t begin, size_t bytes) {
    kernels_->gatherSlots(layer, block_transfer_, slot_transfer_, count);
    block_transfer_.read(&voxels[begin], bytes);
  });
  return voxels;
}

void BlockMap::setVoxels(const std::string& name, const std::vector<int>& slots, const std::string& voxels) {
  forEachTransfer(name, slots, [&](BlockLayer& layer, int count, size_t begin, size_t bytes) {
    block_transfer_.write(&voxels[begin], bytes);
    kernels_->scatterSlots(layer, block_transfer_, slot_transfer_, count);
  });
}

std::vector<int> BlockMap::states(const std::vector<int>& slots) const {
  const std::vector<int> all = block_states_.read<int>(static_cast<size_t>(slots_.bound()));
  std::vector<int> states;
  for (const int slot : slots) states.push_back(all[static_cast<size_t>(slot)]);
  return states;
}

void BlockMap::setStates(const std::vector<int>& slots, const std::vector<int>& states) {
  std::vector<int> all = block_states_.read<int>(static_cast<size_t>(slots_.bound()));
  for (size_t i = 0; i < slots.size(); ++i) all[static_cast<size_t>(slots[i])] = states[i];
  block_states_.write(all);
}

}  // namespace depth_fusion
