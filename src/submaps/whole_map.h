// All the blocks of a map, in the pool and in the store, as they were at a time.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>

#include "depth_fusion/submaps/submap_collection.h"
#include "submaps/block_store.h"
#include "submaps/pool_groups.h"

namespace depth_fusion {

class WholeMap {
 public:
  using Groups = std::set<BlockIndex, BlockOrder>;

  // Copies what is in the pool, and holds on to what is in the store; of all the groups, or of these. Whoever
  // calls it holds what guards the map. Throws Error if the store cannot be read.
  explicit WholeMap(SubmapCollection& submaps, const Groups* only = nullptr);

  // The groups with the number of their blocks. The same group may be in several submaps, of which those come
  // first that were active last.
  const std::map<BlockIndex, std::map<uint32_t, size_t>, BlockOrder>& groups() const { return groups_; }
  const std::vector<LayerRow>& layers() const { return layers_; }
  int blockSize() const { return block_size_; }

  // A submap's group, of each layer. These two may be called at any time, by one thread at a time. Throw
  // Error if it cannot be read.
  BlockGroups group(const GroupKey& key);
  GroupRows rows(const GroupKey& key);
  // The group of W: of a block that several submaps have, that of the one that was active last.
  BlockGroups groupOfWorld(const BlockIndex& group);

 private:
  std::vector<LayerRow> layers_;
  int block_size_;
  uint32_t active_;
  std::vector<uint32_t> by_age_;  // submaps, those that were active last first
  std::map<BlockIndex, std::map<uint32_t, size_t>, BlockOrder> groups_;
  std::map<BlockIndex, BlockGroups, BlockOrder> in_pool_;
  std::unique_ptr<StoreSnapshot> stored_;
};

}  // namespace depth_fusion
