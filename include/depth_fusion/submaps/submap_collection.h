// A map without walls: submaps, of which the pool holds what the sensor sees and has just seen.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "depth_fusion/geometry/camera_intrinsics.h"
#include "depth_fusion/map/block_map.h"
#include "depth_fusion/submaps/map_description.h"
#include "depth_fusion/submaps/store_usage.h"
#include "depth_fusion/submaps/submap_parameters.h"

namespace depth_fusion {

class BlockStore;
class ViewVolume;
struct BlockGroup;

enum class SubmapState { kActive, kInMemory, kInStore };

struct SubmapExtent {
  Eigen::AlignedBox3d box_W;  // about the submap's blocks
  SubmapState state;          // kInStore: some of it is
};

// What is measured goes to the active submap. It ends where the sensor leaves its window: then a submap that
// the sensor is in, and whose place is sure enough, is active again, or another one begins. Blocks that the
// map's window or pool does not hold are in a store, by submap, and come back before they are seen. Submaps
// whose places are sure lie on one grid, so that a block of W is in one of them only, the last that had it in
// the pool.
//
// Nothing here is synchronised but usage().
class SubmapCollection {
 public:
  // Keeps a reference. The map's window and pool are this object's from now on, as long as it lives.
  SubmapCollection(BlockMap& map, const SubmapParameters& parameters);
  ~SubmapCollection();

  // The sensor is at T_W_D, where a frame is to be fused; `is_given`: the pose is from elsewhere, and sure.
  void enter(const Pose& T_W_D, bool is_given);
  // Nothing is known any more of how what is measured from now on lies to what there is: another submap
  // begins where enter() says next, and the others are not sure. False, and nothing has changed, if what
  // there is cannot be stored: problem() says why.
  bool beginPart();
  // Sees to it that the map holds all the blocks that there are in the view up to max_range_m, and can take
  // more. What it cannot do, problem() says.
  void show(const CameraIntrinsics& camera, const Pose& T_W_D, double max_range_m);

  // Clears what is in the region, a part of the box of W, in all submaps: nothing is known of it afterwards.
  // Returns how many blocks had a part in it. Throws Error if blocks cannot be read.
  size_t clear(const Eigen::AlignedBox3d& box_W,
               const std::function<bool(const Eigen::Vector3d& p_W)>& isInside);

  // The groups of blocks that are in the store, counted as row keys have them.
  std::vector<BlockIndex> storedGroups() const;
  // Whether no blocks in the box or the groups about it are elsewhere than in the pool.
  bool isInPool(const BlockBox& box) const;

  // The submaps, in the order in which they began, with the blocks that they have in the pool and elsewhere.
  std::vector<SubmapDescription> submaps() const;
  // Where the submaps are that have blocks.
  std::vector<SubmapExtent> extents() const;
  // The map's window.
  Eigen::AlignedBox3d windowBox() const;
  uint32_t active() const { return active_; }
  BlockMap& map() { return map_; }
  const BlockMap& map() const { return map_; }
  double way_m() const { return way_m_; }
  // The blocks of all the submaps.
  size_t blockCount() const;
  bool isEmpty() const { return blockCount() == 0; }
  StoreUsage usage() const;
  // Why something is left out; empty if all is well.
  std::string problem() const;

 private:
  friend class WholeMap;
  friend class ReadMap;
  using GroupSizes = std::map<BlockIndex, size_t, BlockOrder>;  // in blocks

  struct Submap {
    Window window;
    double left_at_m = 0.0;  // on the sensor's way, when it was active last
    GroupSizes stored;
    size_t stored_blocks = 0;  // of all of them, so that nobody has to go through them
  };

  using BlockSet = std::set<BlockIndex, BlockOrder>;
  using BlockGroups = std::vector<BlockGroup>;  // of each layer, with the same blocks

  using GroupSlots = std::map<BlockIndex, std::vector<int>, BlockOrder>;

  // What is left of a group of blocks.
  using Edit = std::function<BlockGroups(const BlockGroups&)>;
  void clearInPool(const BlockBox& box, const Edit& edit);
  void clearInStore(const BlockBox& box, const Edit& edit);
  // Takes in submaps that are stored, in place of what there is.
  void adopt(const MapDescription& description, std::vector<GroupSizes> stored,
             std::unique_ptr<BlockStore> store, const Window& window);
  Eigen::AlignedBox3d boxInW(const BlockBox& blocks) const;
  BlockIndex blockAt(const Eigen::Vector3d& p_W) const;
  // The store has so many blocks of the submap's group; 0: none.
  void setStored(uint32_t submap, const BlockIndex& group, size_t blocks);
  // Forgets everything if the map was emptied.
  void follow();
  // Another submap begins, and is active.
  void begin(const Window& window);
  void activate(uint32_t submap);
  bool isSure(uint32_t submap) const;
  // The submap to go on with where the active one ends; none if there is none.
  std::optional<uint32_t> submapAbout(const Eigen::Vector3d& p_W) const;

  // Moves the window if the view leaves it; returns whether it did.
  bool moveWindow();
  // Of what the window will leave if it goes on as it moved last, evicts a little that is not in view, so
  // that no frame has to wait for all of it.
  void evictAhead();
  // The slots in use of blocks that are not in the window.
  GroupSlots slotsOutside(const Window& window) const;
  // Puts blocks into the store, and takes them out of the pool; false if the store cannot take all of them.
  bool evict(std::vector<int> slots);
  // Forgets the blocks of slots that are left before any distance in them was sure: a noisy sensor strews
  // others about far surfaces each time it comes by.
  void dropUnsure(std::vector<int>& slots);
  void store(const BlockIndex& group, BlockGroups blocks);
  // Evicts blocks that are not in view, the farthest first, until so many slots are free.
  void makeRoom(size_t slots);
  void bringBackSeen();
  // Fills most of the pool, the nearest first.
  void bringBackNear(const Eigen::Vector3d& p_W);
  // Brings back the absent groups as far as there is room, and returns their blocks.
  BlockSet bringBack(const std::vector<BlockIndex>& groups);
  // The group from the store, as far as it is in the window; the rest stays there.
  BlockGroups takeFromStore(const BlockIndex& group);
  // As BlockMap::BringBack.
  std::vector<BlockIndex> bringBackRequested(std::vector<BlockIndex>& requested);
  // Lists the groups of sure submaps that the window meets and the pool lacks.
  void listAbsent();
  bool isSeen(const BlockIndex& group) const;
  double distance_m(const BlockIndex& group, const Eigen::Vector3d& p_W) const;
  Eigen::Vector3d middleOf(const BlockIndex& group) const;

  BlockMap& map_;
  SubmapParameters parameters_;
  std::vector<LayerRow> layers_;
  int edge_;  // of a group, in blocks
  double block_m_;
  uint32_t generation_ = 0;
  std::vector<Submap> submaps_;
  uint32_t active_ = 0;
  std::map<BlockIndex, uint32_t, BlockOrder> absent_;  // with the submaps that have them
  BlockSet ahead_;                                     // of these, those that are read ahead
  GroupSlots leaving_;                                 // are soon evicted
  std::unique_ptr<ViewVolume> view_;                   // of the last show()
  std::optional<Eigen::Vector3d> sensor_W_;
  double way_m_ = 0.0;     // of the sensor, but where its poses are given
  double length_m_ = 0.0;  // of the way in the active submap
  std::string problem_;
  std::unique_ptr<BlockStore> store_;
};

}  // namespace depth_fusion
