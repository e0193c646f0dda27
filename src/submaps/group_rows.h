// Groups of blocks as rows of a database, a row a layer.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "depth_fusion/store/database.h"
#include "submaps/pool_groups.h"

namespace depth_fusion {

// A group of blocks of a submap.
struct GroupKey {
  uint32_t submap;
  BlockIndex group;

  bool operator<(const GroupKey& other) const {
    if (submap != other.submap) return submap < other.submap;
    return before(group, other.group);
  }
};

using GroupRows = std::vector<std::string>;  // of each layer, packed

// What is held by a pointer, which may be null.
size_t bytesOf(const std::shared_ptr<const BlockGroups>& group);
size_t bytesOf(const std::shared_ptr<const GroupRows>& rows);

std::string keyOf(const GroupKey& key, const LayerRow& layer);
GroupRows packedRows(const GroupKey& key, const BlockGroups& group, const std::vector<LayerRow>& layers,
                     int block_size);
// Throws Error for a damaged row.
BlockGroups unpackedRows(const GroupKey& key, const GroupRows& rows, const std::vector<LayerRow>& layers,
                         int block_size);
// The rows in a database; `place` is its name. Throws Error if they are not there.
GroupRows rowsIn(DatabaseReader& reader, const GroupKey& key, const std::vector<LayerRow>& layers,
                 const std::string& place);

}  // namespace depth_fusion
