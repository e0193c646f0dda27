#include "depth_fusion/map/block_map.h"

#include <algorithm>
#include <utility>

#include "compute/opencl.h"
#include "depth_fusion/common/error.h"
#include "map/map_args.h"
#include "map/map_kernels.h"

namespace depth_fusion {
namespace {

constexpr size_t kTransferBlocks = 16384;  // blocks that one upload of requests names

size_t cube(int n) { return static_cast<size_t>(n) * static_cast<size_t>(n) * static_cast<size_t>(n); }

MapParameters checked(MapParameters parameters) {
  validate(parameters.table());
  const int m = parameters.block_size;
  check((m & (m - 1)) == 0, "map/block_size is " + std::to_string(m) + "; it must be a power of two");
  if (parameters.truncation_m == 0.0f) parameters.truncation_m = 4.0f * parameters.voxel_size_m;
  check(parameters.truncation_m >= 2.0f * parameters.voxel_size_m,
        "map/truncation_m must be at least two voxels, else no surface is seen between them");
  return parameters;
}

// How many blocks the pool holds: map/pool_mib is for the first layer, the TSDF.
size_t poolCapacity(ComputeContext& compute, const MapParameters& map) {
  const std::vector<LayerRow> layers = layersOf(map);
  const size_t pool_bytes = static_cast<size_t>(map.pool_mib) << 20;
  const size_t capacity =
      std::min(pool_bytes / layers.front().bytesPerBlock(map.block_size), cube(map.blocks_per_axis));
  check(capacity > 0, "map/pool_mib holds not even one block");
  const size_t limit = compute.impl().device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
  for (const LayerRow& layer : layers) {
    check(capacity * layer.bytesPerBlock(map.block_size) <= limit,
          "map/pool_mib is too large: the layer " + layer.name + ", of " +
              std::to_string(layer.bytesPerVoxel()) +
              " bytes a voxel, is over the device's largest buffer, " + std::to_string(limit >> 20) + " MiB");
  }
  return capacity;
}

std::vector<BlockLayer> makeLayers(ComputeContext& compute, const std::vector<LayerRow>& rows, int block_size,
                                   size_t capacity) {
  std::vector<BlockLayer> layers;
  layers.reserve(rows.size());
  for (const LayerRow& row : rows) layers.emplace_back(compute, row, block_size, capacity);
  return layers;
}

std::vector<BlockRequest> requestsOf(const BlockIndex* begin, const BlockIndex* end) {
  std::vector<BlockRequest> requests;
  for (const BlockIndex* block = begin; block != end; ++block)
    requests.push_back({block->x(), block->y(), block->z(), 0});
  return requests;
}

}  // namespace

size_t mapBytes(const MapParameters& map, size_t blocks) {
  size_t bytes = 4 * cube(map.blocks_per_axis);
  for (const LayerRow& layer : layersOf(map)) bytes += blocks * layer.bytesPerBlock(map.block_size);
  return bytes;
}

BlockMap::BlockMap(ComputeContext& compute, const MapParameters& parameters)
    : BlockMap(compute, checked(parameters), SlotTable(poolCapacity(compute, checked(parameters))),
               layersOf(parameters)) {
  placeWindow(Eigen::Vector3d::Zero());
}

BlockMap::BlockMap(ComputeContext& compute, const MapParameters& checked, SlotTable slots,
                   const std::vector<LayerRow>& layers)
    : compute_(compute),
      parameters_(checked),
      slots_(std::move(slots)),
      changes_(slots_),
      layers_(makeLayers(compute, layers, checked.block_size, slots_.capacity())),
      offsets_(compute, 4 * cube(checked.blocks_per_axis), "the offsets of map/blocks_per_axis"),
      block_indices_(compute, slots_.capacity() * sizeof(BlockRequest), "the block indices of the map"),
      block_states_(compute, slots_.capacity() * sizeof(int), "the block states of the map"),
      request_transfer_(compute, kTransferBlocks * sizeof(BlockRequest), "block requests"),
      slot_transfer_(compute, kTransferBlocks * sizeof(int), "block slots"),
      kernels_(std::make_unique<MapKernels>(compute, checked)) {}

BlockMap::~BlockMap() = default;

void BlockMap::reset(const Eigen::Vector3d& centre_W) {
  slots_.clear();
  changes_.noteReset();
  placeWindow(centre_W);
}

void BlockMap::resetAt(const BlockIndex& window_origin) {
  slots_.clear();
  changes_.noteReset();
  place({window_origin, parameters_.blocks_per_axis});
}

void BlockMap::placeWindow(const Eigen::Vector3d& centre_W) {
  check(slots_.used() == 0, "the window of a map with blocks cannot be placed anew");
  const double block_m = static_cast<double>(parameters_.voxel_size_m) * parameters_.block_size;
  place(Window::centredOn(centre_W, block_m, parameters_.blocks_per_axis));
}

void BlockMap::place(const Window& window) {
  window_ = window;
  slots_.clear();
  offsets_.fill(BLOCK_EMPTY, offsets_.bytes());
}

void BlockMap::moveWindow(const BlockIndex& origin) {
  const Window moved{origin, parameters_.blocks_per_axis};
  for (int slot = 0; slot < slots_.bound(); ++slot)
    check(!slots_.inUse(slot) || moved.contains(slots_.blockOf(slot)), "the window leaves blocks behind");
  window_ = moved;
}

size_t BlockMap::allocate(const std::vector<BlockIndex>& blocks) {
  std::vector<BlockIndex> missing = blocks;
  const std::vector<BlockIndex> unmet = bring_back_ ? bring_back_(missing) : std::vector<BlockIndex>();
  const std::vector<int> slots = slots_.take(missing);
  const size_t met = blocks.size() - missing.size() - unmet.size() + slots.size();
  missing.insert(missing.end(), unmet.begin(), unmet.end());
  enter(missing, slots);
  changes_.noteUpdated(slots);
  return met;
}

std::vector<int> BlockMap::insert(const std::vector<BlockIndex>& blocks) {
  check(blocks.size() <= slots_.free(), "the pool is full: raise map/pool_mib");
  std::vector<int> slots = slots_.take(blocks);
  enter(blocks, slots);
  changes_.noteReturned(slots);
  return slots;
}

void BlockMap::enter(const std::vector<BlockIndex>& blocks, const std::vector<int>& slots) {
  const size_t met = slots.size();
  for (size_t begin = 0; begin < blocks.size();) {
    // A batch lies wholly on one side of `met`, so that it is either entered or withdrawn.
    const size_t end = std::min(begin + kTransferBlocks, begin < met ? met : blocks.size());
    const int count = static_cast<int>(end - begin);
    request_transfer_.write(requestsOf(blocks.data() + begin, blocks.data() + end));
    if (begin < met) {
      slot_transfer_.write(slots.data() + begin, (end - begin) * sizeof(int));
      kernels_->assignBlocks(*this, request_transfer_, slot_transfer_, count);
      for (BlockLayer& layer : layers_) kernels_->clearBlocks(layer, slot_transfer_, count);
    } else {
      kernels_->withdrawRequests(*this, request_transfer_, count);
    }
    begin = end;
  }
}

void BlockMap::release(const std::vector<int>& slots) {
  slots_.release(slots);
  changes_.noteReleased(slots);
}

void BlockMap::remove(const std::vector<int>& slots) {
  takeOut(slots);
  changes_.noteReleased(slots);
}

void BlockMap::evict(const std::vector<int>& slots) {
  takeOut(slots);
  changes_.noteEvicted(slots);
}

void BlockMap::takeOut(const std::vector<int>& slots) {
  for (size_t begin = 0; begin < slots.size(); begin += kTransferBlocks) {
    const size_t count = std::min(kTransferBlocks, slots.size() - begin);
    slot_transfer_.write(slots.data() + begin, count * sizeof(int));
    kernels_->removeBlocks(*this, slot_transfer_, static_cast<int>(count));
  }
  slots_.release(slots);
}

std::unique_ptr<BlockMap> BlockMap::snapshot(const std::vector<std::string>& names) const {
  std::vector<LayerRow> rows;
  MapParameters parameters = parameters_;
  for (const BlockLayer& layer : layers_) {
    if (std::count(names.begin(), names.end(), layer.name()) > 0) {
      rows.push_back(layer.row());
    } else if (layer.row().wanted != nullptr) {
      parameters.*layer.row().wanted = false;
    }
  }
  std::unique_ptr<BlockMap> copy(new BlockMap(compute_, parameters, slots_.trimmed(), rows));
  const auto slots = static_cast<size_t>(slots_.bound());
  copy->window_ = window_;
  copy->offsets_.copyFrom(offsets_, offsets_.bytes());
  copy->block_indices_.copyFrom(block_indices_, slots * sizeof(BlockRequest));
  copy->block_states_.copyFrom(block_states_, slots * sizeof(int));
  for (const BlockLayer& layer : layers_) {
    if (!copy->hasLayer(layer.name())) continue;
    copy->layer(layer.name())
        .copyFrom(layer.buffer(), slots * layer.row().bytesPerBlock(parameters_.block_size));
  }
  return copy;
}

bool BlockMap::hasLayer(const std::string& name) const {
  return std::any_of(layers_.begin(), layers_.end(), [&](const auto& layer) { return layer.name() == name; });
}

BlockLayer& BlockMap::layerNamed(const std::string& name) {
  const auto found = std::find_if(layers_.begin(), layers_.end(),
                                  [&](const BlockLayer& layer) { return layer.name() == name; });
  check(found != layers_.end(), "the map has no layer " + name);
  return *found;
}

DeviceBuffer& BlockMap::layer(const std::string& name) { return layerNamed(name).buffer(); }

BlockMap::Usage BlockMap::usage() const {
  Usage usage;
  usage.blocks = slots_.used();
  usage.capacity = slots_.capacity();
  usage.bytes = offsets_.bytes();
  usage.pool_bytes = offsets_.bytes() + block_indices_.bytes() + block_states_.bytes();
  for (const BlockLayer& layer : layers_) {
    const size_t bytes = usage.blocks * layer.row().bytesPerBlock(parameters_.block_size);
    usage.layer_bytes[layer.name()] = bytes;
    usage.bytes += bytes;
    usage.pool_bytes += layer.buffer().bytes();
  }
  return usage;
}

}  // namespace depth_fusion
