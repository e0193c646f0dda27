#include <algorithm>
#include <cstring>
#include <utility>

#include "depth_fusion/common/error.h"
#include "depth_fusion/submaps/map_file.h"
#include "map/block_transfer.h"
#include "submaps/block_rows.h"
#include "submaps/description_rows.h"
#include "submaps/keyframe_rows.h"
#include "submaps/row_keys.h"

namespace depth_fusion {
namespace {

std::string rowName(const Database& database, const std::string& key) {
  return database.name() + ", row " + readable(key) + ",";
}

// The window that the map had, or one of another size about the same blocks.
Window windowFor(const SubmapDescription& submap, const BlockMap& map) {
  const int n = map.parameters().blocks_per_axis;
  const Window& stored = submap.window;
  return {stored.origin.array() + (stored.blocks_per_axis - n) / 2, n};
}

}  // namespace

std::unique_ptr<Database> openStoredMap(const std::string& location) {
  std::unique_ptr<Database> database = openIfThere(location);
  if (database != nullptr && !database->read()->get(kDescriptionKey)) return nullptr;
  return database;
}

MapDescription describeMap(const Database& database, DatabaseReader& reader) {
  const std::optional<std::string> row = reader.get(kDescriptionKey);
  check(row.has_value(), database.name() + " holds no map");
  MapDescription description = parseDescription(*row, rowName(database, kDescriptionKey));
  reader.forEach(kSubmapPrefix, [&](const std::string& key, const std::string& value) {
    description.submaps.push_back(parseSubmap(value, rowName(database, key)));
  });
  return description;
}

MapDescription describeMap(Database& database) { return describeMap(database, *database.read()); }

ReadMap::ReadMap(Database& database, const BlockMap& map) {
  const std::unique_ptr<DatabaseReader> reader = database.read();
  loaded_.description = describeMap(database, *reader);
  const MapDescription& stored = loaded_.description;
  const std::string name = database.name();
  check(!stored.submaps.empty(), name + " is damaged: it has no submap");
  MapParameters parameters = map.parameters();
  for (const char* parameter : kVoxelParameters)
    checkSameParameter(stored, parameter, withPrefix("map", parameters.table()), name);
  const SubmapDescription& submap = stored.submaps.front();
  window_ = windowFor(submap, map);
  for (const LayerRow& row : layersOf(map.parameters())) {
    if (std::count(stored.layers.begin(), stored.layers.end(), row.name) > 0)
      readLayer(database, *reader, row, map.parameters().block_size);
  }
  check(!layers_.empty() && layers_.front().blocks.size() == submap.blocks,
        name + " is damaged: it does not have the blocks that it says");
  checkRoom(map, name);
  reader->forEach(keyframePrefix(submap.id), [&](const std::string& key, const std::string& value) {
    loaded_.keyframes.push_back(
        std::make_shared<const Keyframe>(parseKeyframe(value, rowName(database, key))));
    loaded_.keyframe_numbers.push_back(numberOfKey(key));
  });
}

void ReadMap::readLayer(const Database& database, DatabaseReader& reader, const LayerRow& row,
                        int block_size) {
  Layer layer{row, {}, {}, {}};
  const std::string prefix = blocksPrefix(loaded_.description.submaps.front().id, row.name);
  reader.forEach(prefix, [&](const std::string& key, const std::string& value) {
    const BlockGroup group =
        parseBlocks(value, groupOfKey(key, prefix), row, block_size, rowName(database, key));
    layer.blocks.insert(layer.blocks.end(), group.blocks.begin(), group.blocks.end());
    layer.states.insert(layer.states.end(), group.states.begin(), group.states.end());
    layer.voxels += group.voxels;
  });
  check(layers_.empty() || layers_.front().blocks == layer.blocks,
        database.name() + " is damaged: its layer " + row.name + " has other blocks than the first");
  layers_.push_back(std::move(layer));
}

void ReadMap::checkRoom(const BlockMap& map, const std::string& name) const {
  const std::vector<BlockIndex>& blocks = layers_.front().blocks;
  const size_t block_bytes = layers_.front().row.bytesPerBlock(map.parameters().block_size);
  check(blocks.size() <= map.slots().capacity(),
        name + " has " + std::to_string(blocks.size()) + " blocks, and the pool holds " +
            std::to_string(map.slots().capacity()) + "; set map/pool_mib to " +
            std::to_string((blocks.size() * block_bytes >> 20) + 1) + " or more");
  for (const BlockIndex& block : blocks)
    check(window_.contains(block), name + " is larger than the map's window; raise map/blocks_per_axis");
}

void ReadMap::moveTo(BlockMap& map) const {
  const int block_size = map.parameters().block_size;
  map.resetAt(window_.origin);
  const std::vector<int> slots = map.insert(layers_.front().blocks);
  const std::vector<int>& states = layers_.front().states;
  writeSlots(map.blockStates(), slots,
             {reinterpret_cast<const char*>(states.data()), states.size() * sizeof(int)}, sizeof(int));
  for (const Layer& layer : layers_)
    writeSlots(map.layer(layer.row.name), slots, layer.voxels, layer.row.bytesPerBlock(block_size));
}

}  // namespace depth_fusion
