#include "depth_fusion/map/block_sparse_map.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "compute/kernel.h"
#include "depth_fusion/common/error.h"
#include "map/map_args.h"

namespace depth_fusion {
namespace {

constexpr size_t kColorBytes = 4;  // a voxel
constexpr size_t kTransferBlocks = 16384;  // blocks that one upload of requests names

size_t cube(int n) { return static_cast<size_t>(n) * static_cast<size_t>(n) * static_cast<size_t>(n); }

int floorModulo(int a, int n) { return (a % n + n) % n; }

}  // namespace

ParameterTable MapParameters::table() {
  return atStartOnly(
      {{"voxel_size_m", &voxel_size_m, 1e-5, 1.0, "edge of a voxel"},
          {"blocks_per_axis", &blocks_per_axis, 1, 1280, "blocks per axis of the window (the paper's N)"},
          {"block_size", &block_size, 4, 32, "voxels per axis of a block, a power of two (the paper's M)"},
          {"truncation_m", &truncation_m, 0.0, 10.0,
           "distance kept on both sides of a surface (the paper's delta); 0 = four voxels"},
          {"pool_mib", &pool_mib, 1, 2047, "memory for voxels, allocated once; colour takes twice as much again"},
          {"color", &color, 0, 1, "true: the map holds colour, where the recording has it"}});
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
    : compute_(compute), parameters_(parameters) {
  validate(parameters_.table());
  const int m = parameters_.block_size;
  check((m & (m - 1)) == 0, "map/block_size is " + std::to_string(m) + "; it must be a power of two");
  if (parameters_.truncation_m == 0.0f) parameters_.truncation_m = 4.0f * parameters_.voxel_size_m;
  check(parameters_.truncation_m >= 2.0f * parameters_.voxel_size_m,
        "map/truncation_m must be at least two voxels, else no surface is seen between them");
  const size_t block_bytes = 2 * cube(m);
  capacity_ = std::min((static_cast<size_t>(parameters_.pool_mib) << 20) / block_bytes,
                       cube(parameters_.blocks_per_axis));
  check(capacity_ > 0, "map/pool_mib holds not even one block");
  const size_t limit = compute.impl().device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
  check(capacity_ * block_bytes <= limit, "map/pool_mib is over the device's largest buffer, " +
                                              std::to_string(limit >> 20) + " MiB");
  const size_t color_bytes = parameters_.color ? kColorBytes * capacity_ * cube(m) : 0;
  check(color_bytes <= limit, "map/pool_mib is, with map/color, over the half of the device's largest buffer, " +
                                  std::to_string(limit >> 20) + " MiB");
  offsets_ = DeviceBuffer(compute, 4 * cube(parameters_.blocks_per_axis), "the offsets of map/blocks_per_axis");
  voxels_ = DeviceBuffer(compute, capacity_ * block_bytes, "the voxels of map/pool_mib");
  if (parameters_.color) colors_ = DeviceBuffer(compute, color_bytes, "the colours of map/color");
  block_indices_ = DeviceBuffer(compute, capacity_ * sizeof(BlockRequest), "the block indices of the map");
  block_states_ = DeviceBuffer(compute, capacity_ * sizeof(int), "the block states of the map");
  request_transfer_ = DeviceBuffer(compute, kTransferBlocks * sizeof(BlockRequest), "block requests");
  slot_transfer_ = DeviceBuffer(compute, kTransferBlocks * sizeof(int), "block slots");
  kernels_ = std::make_unique<Kernels>(compute, blockSizeOption(parameters_));
  reset(Eigen::Vector3d::Zero());
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
    request_transfer_.write(requests);
    if (begin < met) {
      slot_transfer_.write(slots);
      kernels_->assign.run(count, offsets_, block_indices_, block_states_, request_transfer_, slot_transfer_, count,
                           grid);
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
    check(slot >= 0 && slot < slot_bound_ && slot_in_use_[slot], "the map releases a block that is not in use");
    slot_in_use_[slot] = false;
    free_slots_.push_back(slot);
  }
}

BlockSparseMap::Usage BlockSparseMap::usage() const {
  Usage usage;
  usage.blocks = capacity_ - free_slots_.size();
  usage.capacity = capacity_;
  const size_t voxels = usage.blocks * cube(parameters_.block_size);
  usage.color_bytes = parameters_.color ? kColorBytes * voxels : 0;
  usage.bytes = 2 * voxels + usage.color_bytes + 4 * cube(parameters_.blocks_per_axis);
  usage.pool_bytes =
      offsets_.bytes() + voxels_.bytes() + colors_.bytes() + block_indices_.bytes() + block_states_.bytes();
  return usage;
}

std::vector<BlockSparseMap::Block> BlockSparseMap::blocks() const {
  std::vector<Block> blocks;
  for (int slot = 0; slot < slot_bound_; ++slot) {
    if (slot_in_use_[slot]) blocks.push_back({slot_blocks_[slot], slot});
  }
  std::sort(blocks.begin(), blocks.end(), [](const Block& a, const Block& b) { return before(a.index, b.index); });
  return blocks;
}

}  // namespace depth_fusion
