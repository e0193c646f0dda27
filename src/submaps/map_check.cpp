#include "depth_fusion/submaps/map_check.h"

#include <algorithm>
#include <memory>

#include "depth_fusion/common/error.h"
#include "depth_fusion/submaps/map_file.h"
#include "submaps/keyframe_rows.h"
#include "submaps/layer_rows.h"
#include "submaps/row_keys.h"

namespace depth_fusion {
namespace {

void checkLayers(const SubmapDescription& submap, const RowSource& rows, MapCheck& result) {
  const int block_size = blockSizeOf(result.description);
  GroupBlocks first;
  for (const LayerRow& layer : storedLayers(result.description)) {
    const bool is_first = first.empty();
    forEachGroup(
        rows, submap.id, layer, block_size, result.problems,
        [&](const std::string& key, const std::string& row, const BlockIndex& index, BlockGroup group) {
          result.blocks[layer.name] += group.blocks.size();
          result.row_bytes[layer.name] += row.size();
          if (is_first) {
            first[index] = std::move(group.blocks);
          } else if (first[index] != group.blocks) {
            result.problems.push_back("row " + readable(key) + " has other blocks than the first layer");
          }
        });
  }
}

void checkKeyframes(const SubmapDescription& submap, const RowSource& rows, MapCheck& result) {
  rows(keyframePrefix(submap.id), [&](const std::string& key, const std::string& row) {
    try {
      parseKeyframe(row, "row " + readable(key));
      ++result.keyframes;
      result.row_bytes["keyframes"] += row.size();
    } catch (const Error& error) {
      result.problems.emplace_back(error.what());
    }
  });
}

}  // namespace

MapCheck checkMap(Database& database) {
  MapCheck result;
  const std::unique_ptr<DatabaseReader> reader = database.read();
  result.description = describeMap(database, *reader);
  const RowSource rows = [&](const std::string& prefix, const DatabaseReader::Visit& visit) {
    reader->forEach(prefix, visit);
  };
  uint64_t expected = 0;
  for (const SubmapDescription& submap : result.description.submaps) {
    expected += submap.blocks;
    checkLayers(submap, rows, result);
    checkKeyframes(submap, rows, result);
  }
  for (const std::string& layer : result.description.layers) {
    if (result.blocks[layer] != expected)
      result.problems.push_back("the layer " + layer + " has " + std::to_string(result.blocks[layer]) +
                                " of its " + std::to_string(expected) + " blocks");
  }
  return result;
}

}  // namespace depth_fusion
