#include "submaps/group_rows.h"

#include <utility>

#include "depth_fusion/common/error.h"
#include "submaps/row_keys.h"

namespace depth_fusion {

size_t bytesOf(const std::shared_ptr<const BlockGroups>& group) {
  size_t bytes = 0;
  if (group != nullptr) {
    for (const BlockGroup& layer : *group) bytes += layer.voxels.size();
  }
  return bytes;
}

size_t bytesOf(const std::shared_ptr<const GroupRows>& rows) {
  size_t bytes = 0;
  if (rows != nullptr) {
    for (const std::string& row : *rows) bytes += row.size();
  }
  return bytes;
}

std::string keyOf(const GroupKey& key, const LayerRow& layer) {
  return blocksKey(key.submap, layer.name, key.group);
}

GroupRows packedRows(const GroupKey& key, const BlockGroups& group, const std::vector<LayerRow>& layers,
                     int block_size) {
  GroupRows rows;
  for (size_t i = 0; i < layers.size(); ++i)
    rows.push_back(blocksRow(group[i], key.group, layers[i], block_size));
  return rows;
}

BlockGroups unpackedRows(const GroupKey& key, const GroupRows& rows, const std::vector<LayerRow>& layers,
                         int block_size) {
  BlockGroups group;
  for (size_t i = 0; i < layers.size(); ++i)
    group.push_back(parseBlocks(rows[i], key.group, layers[i], block_size,
                                "the store's row " + readable(keyOf(key, layers[i]))));
  return group;
}

GroupRows rowsIn(DatabaseReader& reader, const GroupKey& key, const std::vector<LayerRow>& layers,
                 const std::string& place) {
  GroupRows rows;
  for (const LayerRow& layer : layers) {
    std::optional<std::string> row = reader.get(keyOf(key, layer));
    check(row.has_value(), place + " has lost a row, " + readable(keyOf(key, layer)));
    rows.push_back(std::move(*row));
  }
  return rows;
}

}  // namespace depth_fusion
