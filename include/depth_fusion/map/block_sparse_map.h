// The block-sparse TSDF of the paper, section "Volumetric Scene Representation".
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "depth_fusion/compute/compute_context.h"
#include "depth_fusion/compute/device_buffer.h"
#include "depth_fusion/map/map_parameters.h"

namespace depth_fusion {

// 2 * blocks * M^3 + 4 * N^3, the paper's formula; 6 in place of 2 with colour.
size_t mapBytes(const MapParameters& map, size_t blocks);

// A window of N^3 blocks of M^3 voxels. Two device buffers, both allocated once: `offsets`, one int a block
// (the slot of its voxels in the pool, -1 = empty), and the pool of voxels, two bytes each: M^3 signed
// distance bytes (-128 = chi) followed by M^3 certainty bytes a slot. The host keeps the list of free slots.
// Block (i, j, k) covers the voxels M*(i, j, k) and on; voxel v samples the point voxel_size_m * v of W; a
// block's address in `offsets` is its index modulo N in each axis, so that the window may start anywhere.
// With `color`, a third buffer holds four bytes more a voxel: blue, green, red and weight (0 = none), M^3 of
// them a slot.
class BlockSparseMap {
 public:
  using BlockIndex = Eigen::Vector3i;
  using BlockBox = Eigen::AlignedBox3i;

  struct Usage {
    size_t blocks = 0;       // in use
    size_t capacity = 0;     // blocks that the pool holds
    size_t bytes = 0;        // as mapBytes() has it
    size_t color_bytes = 0;  // of `bytes`
    size_t pool_bytes = 0;   // device memory really allocated for the map
  };

  // Throws Error for invalid parameters or if the device cannot hold the map.
  BlockSparseMap(ComputeContext& compute, const MapParameters& parameters);
  ~BlockSparseMap();

  // Empties the map and places the middle of the window at the block with the point centre_W.
  void reset(const Eigen::Vector3d& centre_W);

  // Gives memory, filled with chi, to the first of the blocks as long as there are free slots. The blocks are
  // those that block selection requested, inside the window and not allocated; requests not met are
  // withdrawn. Returns how many were met.
  size_t allocate(const std::vector<BlockIndex>& blocks);

  // Takes back the slots, which must be in use. Their entries of `offsets` are already empty on the device.
  void release(const std::vector<int>& slots);

  // A copy of the map as it is now, for reading it while this one goes on changing. It takes 4 * N^3 bytes
  // and, for each of the slotBound() slots, 2 * M^3 + 20 (6 * M^3 + 20 with colour). The copy is made on the
  // device, in the order of its queue: this map may change as soon as the call returns. `with_color` false
  // leaves the colours out.
  std::unique_ptr<BlockSparseMap> snapshot(bool with_color = true) const;

  Usage usage() const;
  // With the truncation in metres also where it was given as 0.
  const MapParameters& parameters() const { return parameters_; }
  // Slots [0, slotBound()) have been in use at some time.
  int slotBound() const { return slot_bound_; }
  // The blocks in use with their slots, sorted by z, y, x.
  struct Block {
    BlockIndex index;
    int slot;
  };
  std::vector<Block> blocks() const;
  // Of a slot below slotBound(): whether it is in use, and the block that it holds or held last.
  bool inUse(int slot) const { return slot_in_use_[slot]; }
  const BlockIndex& blockOf(int slot) const { return slot_blocks_[slot]; }
  // The boxes about the blocks of SLOTS_PER_GROUP slots each, one after the other; empty where none is in
  // use.
  const std::vector<BlockBox>& groupBoxes() const { return group_boxes_; }

  // First block of the window.
  const BlockIndex& origin() const { return origin_; }

  DeviceBuffer& offsets() { return offsets_; }
  DeviceBuffer& voxels() { return voxels_; }
  // Holds nothing without MapParameters::color.
  DeviceBuffer& colors() { return colors_; }
  // Four ints a slot: block index x, y, z, and 1 if in use, else 0.
  DeviceBuffer& blockIndices() { return block_indices_; }
  // An int a slot: bits BLOCK_HAS_DATA, BLOCK_NEAR_SURFACE.
  DeviceBuffer& blockStates() { return block_states_; }

 private:
  struct Kernels;

  // With room for `capacity` blocks; the caller sets the contents.
  BlockSparseMap(ComputeContext& compute, const MapParameters& checked, size_t capacity);

  // After a change of these slots.
  void updateGroupBoxes(const std::vector<int>& slots);

  ComputeContext& compute_;
  MapParameters parameters_;
  size_t capacity_ = 0;
  BlockIndex origin_ = BlockIndex::Zero();
  DeviceBuffer offsets_, voxels_, colors_, block_indices_, block_states_, request_transfer_, slot_transfer_;
  std::vector<int> free_slots_;
  std::vector<BlockIndex> slot_blocks_;
  std::vector<bool> slot_in_use_;
  std::vector<BlockBox> group_boxes_;
  int slot_bound_ = 0;
  std::unique_ptr<Kernels> kernels_;
};

}  // namespace depth_fusion
