// The block-sparse map of the paper, section "Volumetric Scene Representation".
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "depth_fusion/compute/compute_context.h"
#include "depth_fusion/compute/device_buffer.h"
#include "depth_fusion/map/block_layer.h"
#include "depth_fusion/map/map_changes.h"
#include "depth_fusion/map/map_parameters.h"
#include "depth_fusion/map/slot_table.h"
#include "depth_fusion/map/window.h"

namespace depth_fusion {

class MapKernels;

// 4 * N^3 bytes and, for each block, M^3 times what its layers take a voxel: 2 bytes of TSDF (the paper's
// formula), 4 of colour.
size_t mapBytes(const MapParameters& map, size_t blocks);

// A window of blocks of M^3 voxels, those in use in slots of layers, all in device buffers allocated once.
// Voxel v samples the point voxel_size_m * v of W. `offsets` has an int for each block of the window at its
// address: the slot, or -1 if the block is not in use.
class BlockMap {
 public:
  struct Usage {
    size_t blocks = 0;                          // in use
    size_t capacity = 0;                        // blocks that the pool holds
    size_t bytes = 0;                           // as mapBytes() has it
    size_t pool_bytes = 0;                      // device memory really allocated for the map
    std::map<std::string, size_t> layer_bytes;  // the part of `bytes` that each layer has, by its name

    // 0 for a layer that the map does not have.
    size_t bytesOf(const std::string& layer) const {
      const auto found = layer_bytes.find(layer);
      return found == layer_bytes.end() ? 0 : found->second;
    }
  };

  // Throws Error for invalid parameters or if the device cannot hold the map.
  BlockMap(ComputeContext& compute, const MapParameters& parameters);
  ~BlockMap();

  // Is asked for blocks before they are made: takes those out of the list that are kept elsewhere, and
  // inserts them; returns those of them that there is no room for.
  using BringBack = std::function<std::vector<BlockIndex>(std::vector<BlockIndex>& requested)>;

  // Empties the map and places the middle of the window at the block with the point centre_W, or its first
  // block at the origin. A new generation begins.
  void reset(const Eigen::Vector3d& centre_W);
  void resetAt(const BlockIndex& window_origin);
  // Places the window of a map without blocks; the generation goes on.
  void placeWindow(const Eigen::Vector3d& centre_W);

  // Moves the window to where all the blocks of the map are inside, too. They keep their places.
  void moveWindow(const BlockIndex& origin);

  // Gives memory, cleared, to the first of the blocks as long as there are free slots. The blocks are those
  // that block selection requested, inside the window and not allocated; requests not met are withdrawn.
  // Returns how many were met.
  size_t allocate(const std::vector<BlockIndex>& blocks);
  // Gives memory to the blocks, which are inside the window and not in the map, and returns their slots:
  // their contents are for the caller to write, as they were when the map had them last, if it ever had.
  // Throws Error if there is no room for all.
  std::vector<int> insert(const std::vector<BlockIndex>& blocks);
  // Takes back the slots, which must be in use. Their entries of `offsets` are already empty on the device.
  void release(const std::vector<int>& slots);
  // Takes the blocks of the slots, which must be in use, out of the map.
  void remove(const std::vector<int>& slots);
  // Takes back the slots, which must be in use, of blocks that are kept elsewhere from now on.
  void evict(const std::vector<int>& slots);
  // The blocks that are kept elsewhere are looked for there before allocate() makes them; null: nowhere.
  void bringBackBy(BringBack bring_back) { bring_back_ = std::move(bring_back); }

  // Whoever wants to know what changes holds a subscription. It is told of allocation, release and reset by
  // the map itself, and of other contents by whoever writes them and says so here; that may be left out, with
  // what it costs to know the slots, while nobody follows.
  MapSubscription follow() { return changes_.subscribe(); }
  bool isFollowed() const { return changes_.isFollowed(); }
  void noteUpdated(const std::vector<int>& slots) { changes_.noteUpdated(slots); }
  // Blocks that are kept elsewhere have other contents.
  void noteChangedElsewhere(const std::vector<BlockIndex>& blocks) { changes_.noteChangedElsewhere(blocks); }
  uint32_t generation() const { return changes_.generation(); }

  // A copy of the map as it is now, with those of the named layers that it has, for reading it while this one
  // goes on changing. It takes 4 * N^3 bytes and, for each of the slots below bound(), 20 bytes and its
  // layers'. The copy is made on the device, in the order of its queue: this map may change as soon as the
  // call returns.
  std::unique_ptr<BlockMap> snapshot(const std::vector<std::string>& layers) const;

  // The contents of slots in use, block by block: a layer's voxels, and the states. Throw Error for a layer
  // that the map does not have.
  std::string voxels(const std::string& layer, const std::vector<int>& slots);
  void setVoxels(const std::string& layer, const std::vector<int>& slots, const std::string& voxels);
  std::vector<int> states(const std::vector<int>& slots) const;
  void setStates(const std::vector<int>& slots, const std::vector<int>& states);

  Usage usage() const;
  // The truncation is in metres also where it was given as 0.
  const MapParameters& parameters() const { return parameters_; }
  const Window& window() const { return window_; }
  const SlotTable& slots() const { return slots_; }

  DeviceBuffer& offsets() { return offsets_; }
  bool hasLayer(const std::string& name) const;
  // Throws Error for a layer that the map does not have.
  DeviceBuffer& layer(const std::string& name);
  // Four ints a slot: block index x, y, z, and 1 if in use, else 0.
  DeviceBuffer& blockIndices() { return block_indices_; }
  // An int a slot: bits BLOCK_HAS_DATA, BLOCK_NEAR_SURFACE.
  DeviceBuffer& blockStates() { return block_states_; }

 private:
  BlockLayer& layerNamed(const std::string& name);
  // Calls with as many of the slots at a time as are copied at once.
  template <class Function>
  void forEachTransfer(const std::string& layer, const std::vector<int>& slots, const Function& function);
  void place(const Window& window);
  void takeOut(const std::vector<int>& slots);
  // Enters the first of the blocks with these slots, as many as there are, and clears them; the requests of
  // the others are withdrawn.
  void enter(const std::vector<BlockIndex>& blocks, const std::vector<int>& slots);

  // The caller sets the contents.
  BlockMap(ComputeContext& compute, const MapParameters& checked, SlotTable slots,
           const std::vector<LayerRow>& layers);

  ComputeContext& compute_;
  MapParameters parameters_;
  Window window_;
  SlotTable slots_;
  ChangeLog changes_;
  BringBack bring_back_;
  std::vector<BlockLayer> layers_;
  DeviceBuffer offsets_, block_indices_, block_states_, request_transfer_, slot_transfer_;
  DeviceBuffer block_transfer_;  // made when it is needed
  std::unique_ptr<MapKernels> kernels_;
};

}  // namespace depth_fusion
