#include "depth_fusion/map/block_sparse_map.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "compute/kernel.h"
#include "depth_fusion/common/error.h"
#include "map/map_args.h"

namespace depth_fusion {
namespace {

constexpr size_t kColorBytes = 4;          // a voxel
constexpr size_t kTransferBlocks = 16384;  // blocks that one upload of requests names

size_t cube(int n) { return static_cast<size_t>(n) * static_cast<size_t>(n) * static_cast<size_t>(n); }

int floorModulo(int a, int n) { return (a % n + n) % n; }

// Bytes of a block in the pool, and of its colours.
size_t blockBytes(const MapParameters& map) { return 2 * cube(map.block_size); }
size_t blockColorBytes(const MapParameters& map) {
  return map.color ? kColorBytes * cube(map.block_size) : 0;
}

MapParameters checked(MapParameters parameters) {
  validate(parameters.table());
  const int m = parameters.block_size;
  check((m & (m - 1)) == 0, "map/block_size is " + std::to_string(m) + "; it must be a power of two");
  if (parameters.truncation_m == 0.0f) parameters.truncation_m = 4.0f * parameters.voxel_size_m;
  check(parameters.truncation_m >= 2.0f * parameters.voxel_size_m,
        "map/truncation_m must be at least two voxels, else no surface is seen between them");
  return parameters;
}

// How many blocks the pool holds.
size_t poolCapacity(ComputeContext& compute, const MapParameters& parameters) {
  const size_t capacity = std::min((static_cast<size_t>(parameters.pool_mib) << 20) / blockBytes(parameters),
                                   cube(parameters.blocks_per_axis));
  check(capacity > 0, "map/pool_mib holds not even one block");
  const size_t limit = compute.impl().device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
  check(capacity * blockBytes(parameters) <= limit,
        "map/pool_mib is over the device's largest buffer, " + std::to_string(limit >> 20) + " MiB");
  check(capacity * blockColorBytes(parameters) <= limit,
        "map/pool_mib is, with map/color, over the half of the device's largest buffer, " +
            std::to_string(limit >> 20) + " MiB");
  return capacity;
}

}  // namespace

size_t mapBytes(const MapParameters& map, size_t blocks) {
  return blocks * (blockBytes(map) + blockColorBytes(map)) + 4 * cube(map.blocks_per_axis);
}

GridArgs gridArgs(const BlockSparseMap& map) {
  const MapParameters& parameters = map.parameters();
  GridArgs args{};
  args.voxel_size_m = parameters.voxel_size_m;
  args.truncation_m = parameters.truncation_m;
  args.blocks_per_axis = parameters.blocks_per_axis;
  for (int axis = 0; axis < 3; ++axis) {
    args.origin[axis] = map.origin()[axis];
    args.wrapped_origin[axis] = floorModulo(map.origin()[axis], parameters.blocks_per_axis);
  }
  return args;
}

std::string blockSizeOption(const MapParameters& parameters) {
  return "-DBLOCK_SIZE_LOG2=" + std::to_string(static_cast<int>(std::log2(parameters.block_size)));
}

struct BlockSparseMap::Kernels {
  Kernel assign, clear, clear_colors, withdraw;
  Kernels(ComputeContext& compute, const std::string& options)
      : assign(compute, "map/blocks.cl", "assign_blocks", options),
        clear(compute, "map/blocks.cl", "clear_blocks", options),
        clear_colors(compute, "map/blocks.cl", "clear_colors", options),
        withdraw(compute, "map/blocks.cl", "withdraw_requests", options) {}
};

BlockSparseMap::BlockSparseMap(ComputeContext& compute, const MapParameters& parameters)
    : BlockSparseMap(compute, checked(parameters), poolCapacity(compute, checked(parameters))) {
  reset(Eigen::Vector3d::Zero());
}

BlockSparseMap::BlockSparseMap(ComputeContext& compute, const MapParameters& checked, size_t capacity)
    : compute_(compute),
      parameters_(checked),
      capacity_(capacity),
      offsets_(compute, 4 * cube(checked.blocks_per_axis), "the offsets of map/blocks_per_axis"),
      voxels_(compute, capacity * blockBytes(checked), "the voxels of map/pool_mib"),
      block_indices_(compute, capacity * sizeof(BlockRequest), "the block indices of the map"),
      block_states_(compute, capacity * sizeof(int), "the block states of the map"),
      request_transfer_(compute, kTransferBlocks * sizeof(BlockRequest), "block requests"),
      slot_transfer_(compute, kTransferBlocks * sizeof(int), "block slots"),
      kernels_(std::make_unique<Kernels>(compute, blockSizeOption(checked))) {
  if (blockColorBytes(checked) > 0)
    colors_ = DeviceBuffer(compute, capacity * blockColorBytes(checked), "the colours of map/color");
}

BlockSparseMap::~BlockSparseMap() = default;

void BlockSparseMap::reset(const Eigen::Vector3d& centre_W) {
  const double block_m = static_cast<double>(parameters_.voxel_size_m) * parameters_.block_size;
  for (int axis = 0; axis < 3; ++axis) {
    origin_[axis] = static_cast<int>(std::floor(centre_W[axis] / block_m)) - parameters_.blocks_per_axis / 2;
  }
  offsets_.fill(BLOCK_EMPTY, offsets_.bytes());
  free_slots_.resize(capacity_);
  std::iota(free_slots_.rbegin(), free_slots_.rend(), 0);
  slot_blocks_.clear();
  slot_in_use_.clear();
  group_boxes_.clear();
  slot_bound_ = 0;
}

size_t BlockSparseMap::allocate(const std::vector<BlockIndex>& blocks) {
  const GridArgs grid = gridArgs(*this);
  const size_t met = std::min(blocks.size(), free_slots_.size());
  const size_t voxel_groups = cube(parameters_.block_size) / 16;
  for (size_t begin = 0; begin < blocks.size();) {
    // A batch lies wholly on one side of `met`, so that one kernel serves it.
    const size_t end = std::min(begin + kTransferBlocks, begin < met ? met : blocks.size());
    const int count = static_cast<int>(end - begin);
    std::vector<BlockRequest> requests;
    std::vector<int> slots;
    for (size_t i = begin; i < end; ++i) {
      requests.push_back({blocks[i].x(), blocks[i].y(), blocks[i].z(), 0});
      if (i >= met) continue;
      const int slot = free_slots_.back();
      free_slots_.pop_back();
      slots.push_back(slot);
      if (slot >= slot_bound_) {
        slot_bound_ = slot + 1;
        slot_blocks_.resize(slot_bound_);
        slot_in_use_.resize(slot_bound_, false);
      }
      slot_blocks_[slot] = blocks[i];
      slot_in_use_[slot] = true;
    }
    updateGroupBoxes(slots);
    request_transfer_.write(requests);
    if (begin < met) {
      slot_transfer_.write(slots);
      kernels_->assign.run(count, offsets_, block_indices_, block_states_, request_transfer_, slot_transfer_,
                           count, grid);
      kernels_->clear.run(count * voxel_groups, voxels_, slot_transfer_, count);
      if (parameters_.color) kernels_->clear_colors.run(count * voxel_groups, colors_, slot_transfer_, count);
    } else {
      kernels_->withdraw.run(count, offsets_, request_transfer_, count, grid);
    }
    begin = end;
  }
  return met;
}

void BlockSparseMap::release(const std::vector<int>& slots) {
  for (const int slot : slots) {
    check(slot >= 0 && slot < slot_bound_ && slot_in_use_[slot],
          "the map releases a block that is not in use");
    slot_in_use_[slot] = false;
    free_slots_.push_back(slot);
  }
  updateGroupBoxes(slots);
}

void BlockSparseMap::updateGroupBoxes(const std::vector<int>& slots) {
  group_boxes_.resize((slot_bound_ + SLOTS_PER_GROUP - 1) / SLOTS_PER_GROUP);
  int last_group = -1;
  for (const int slot : slots) {
    const int group = slot / SLOTS_PER_GROUP;
    if (group == std::exchange(last_group, group)) continue;
    group_boxes_[group].setEmpty();
    const int end = std::min((group + 1) * SLOTS_PER_GROUP, slot_bound_);
    for (int i = group * SLOTS_PER_GROUP; i < end; ++i) {
      if (slot_in_use_[i]) group_boxes_[group].extend(slot_blocks_[i]);
    }
  }
}

std::unique_ptr<BlockSparseMap> BlockSparseMap::snapshot(bool with_color) const {
  MapParameters parameters = parameters_;
  parameters.color = parameters.color && with_color;
  const size_t slots = static_cast<size_t>(slot_bound_);
  std::unique_ptr<BlockSparseMap> copy(new BlockSparseMap(compute_, parameters, std::max<size_t>(slots, 1)));
  copy->offsets_.copyFrom(offsets_, offsets_.bytes());
  copy->voxels_.copyFrom(voxels_, slots * blockBytes(parameters));
  copy->colors_.copyFrom(colors_, slots * blockColorBytes(parameters));
  copy->block_indices_.copyFrom(block_indices_, slots * sizeof(BlockRequest));
  copy->block_states_.copyFrom(block_states_, slots * sizeof(int));
  copy->origin_ = origin_;
  copy->slot_blocks_ = slot_blocks_;
  copy->slot_in_use_ = slot_in_use_;
  copy->group_boxes_ = group_boxes_;
  copy->slot_bound_ = slot_bound_;
  for (int slot = 0; slot < static_cast<int>(copy->capacity_); ++slot) {
    if (slot >= slot_bound_ || !slot_in_use_[slot]) copy->free_slots_.push_back(slot);
  }
  return copy;
}

BlockSparseMap::Usage BlockSparseMap::usage() const {
  Usage usage;
  usage.blocks = capacity_ - free_slots_.size();
  usage.capacity = capacity_;
  usage.color_bytes = usage.blocks * blockColorBytes(parameters_);
  usage.bytes = mapBytes(parameters_, usage.blocks);
  usage.pool_bytes =
      offsets_.bytes() + voxels_.bytes() + colors_.bytes() + block_indices_.bytes() + block_states_.bytes();
  return usage;
}

std::vector<BlockSparseMap::Block> BlockSparseMap::blocks() const {
  std::vector<Block> blocks;
  for (int slot = 0; slot < slot_bound_; ++slot) {
    if (slot_in_use_[slot]) blocks.push_back({slot_blocks_[slot], slot});
  }
  std::sort(blocks.begin(), blocks.end(),
            [](const Block& a, const Block& b) { return before(a.index, b.index); });
  return blocks;
}

}  // namespace depth_fusion
