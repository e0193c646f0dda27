#include <algorithm>
#include <cstring>
#include <filesystem>
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

// A layer's blocks, in the order of their rows.
struct LayerContents {
  LayerRow layer;
  std::vector<BlockGroup> groups;
};

std::string rowName(const Database& database, const std::string& key) {
  return database.name() + ", row " + readable(key) + ",";
}

MapDescription describe(const Database& database, DatabaseReader& reader) {
  const std::optional<std::string> row = reader.get(kDescriptionKey);
  check(row.has_value(), database.name() + " holds no map");
  MapDescription description = parseDescription(*row, rowName(database, kDescriptionKey));
  reader.forEach(kSubmapPrefix, [&](const std::string& key, const std::string& value) {
    description.submaps.push_back(parseSubmap(value, rowName(database, key)));
  });
  return description;
}

// The voxels of the two maps are the same places, and mean the same.
void checkFits(const MapDescription& stored, const BlockMap& map, const std::string& name) {
  MapParameters parameters = map.parameters();
  for (const Parameter& row : parameters.table()) {
    const bool must_agree =
        row.name == "voxel_size_m" || row.name == "block_size" || row.name == "truncation_m";
    if (!must_agree) continue;
    const std::string& theirs = stored.parameter("map/" + row.name);
    check(theirs == valueText(row), name + " was made with map/" + row.name + " " + theirs +
                                        ", and this map has " + valueText(row) + "; set it to " + theirs);
  }
}

size_t blockCount(const LayerContents& contents) {
  size_t count = 0;
  for (const BlockGroup& group : contents.groups) count += group.blocks.size();
  return count;
}

void checkRoom(const LayerContents& contents, const Window& window, const BlockMap& map,
               const std::string& name) {
  const size_t blocks = blockCount(contents);
  const size_t block_bytes = contents.layer.bytesPerBlock(map.parameters().block_size);
  check(blocks <= map.slots().capacity(),
        name + " has " + std::to_string(blocks) + " blocks, and the pool holds " +
            std::to_string(map.slots().capacity()) + "; set map/pool_mib to " +
            std::to_string((blocks * block_bytes >> 20) + 1) + " or more");
  for (const BlockGroup& group : contents.groups) {
    for (const BlockIndex& block : group.blocks) {
      check(window.contains(block), name + " is larger than the map's window; raise map/blocks_per_axis");
    }
  }
}

LayerContents readLayer(Database& database, DatabaseReader& reader, const SubmapDescription& submap,
                        const LayerRow& layer, int block_size) {
  LayerContents contents{layer, {}};
  const std::string prefix = blocksPrefix(submap.id, layer.name);
  reader.forEach(prefix, [&](const std::string& key, const std::string& value) {
    contents.groups.push_back(
        parseBlocks(value, groupOfKey(key, prefix), layer, block_size, rowName(database, key)));
  });
  return contents;
}

// The window that the map had, or one of another size about the same blocks.
Window windowFor(const SubmapDescription& submap, const BlockMap& map) {
  const int n = map.parameters().blocks_per_axis;
  const Window& stored = submap.window;
  return {stored.origin.array() + (stored.blocks_per_axis - n) / 2, n};
}

// The layers that both maps have, the TSDF first. Their rows hold the same blocks.
std::vector<LayerContents> readLayers(Database& database, DatabaseReader& reader,
                                      const MapDescription& stored, const BlockMap& map) {
  std::vector<LayerContents> layers;
  for (const LayerRow& layer : layersOf(map.parameters())) {
    if (std::count(stored.layers.begin(), stored.layers.end(), layer.name) == 0) continue;
    layers.push_back(readLayer(database, reader, stored.submaps.front(), layer, map.parameters().block_size));
    const auto holds_same = [](const BlockGroup& a, const BlockGroup& b) { return a.blocks == b.blocks; };
    const auto& first = layers.front().groups;
    const auto& groups = layers.back().groups;
    check(std::equal(first.begin(), first.end(), groups.begin(), groups.end(), holds_same),
          database.name() + " is damaged: its layer " + layer.name + " has other blocks than the first");
  }
  return layers;
}

// All at once, for the slots of an empty map follow each other.
void fill(BlockMap& map, const std::vector<LayerContents>& layers) {
  const int block_size = map.parameters().block_size;
  std::vector<BlockIndex> blocks;
  std::vector<int> states;
  for (const BlockGroup& group : layers.front().groups) {
    blocks.insert(blocks.end(), group.blocks.begin(), group.blocks.end());
    states.insert(states.end(), group.states.begin(), group.states.end());
  }
  const std::vector<int> slots = map.insert(blocks);
  writeSlots(map.blockStates(), slots,
             {reinterpret_cast<const char*>(states.data()), states.size() * sizeof(int)}, sizeof(int));
  for (const LayerContents& contents : layers) {
    std::string voxels;
    for (const BlockGroup& group : contents.groups) voxels += group.voxels;
    writeSlots(map.layer(contents.layer.name), slots, voxels, contents.layer.bytesPerBlock(block_size));
  }
}

}  // namespace

std::unique_ptr<Database> openStoredMap(const std::string& location) {
  if (!isOnServer(location) && !std::filesystem::exists(location)) return nullptr;
  std::unique_ptr<Database> database =
      openDatabase(location, isOnServer(location) ? DatabaseAccess::kWrite : DatabaseAccess::kRead);
  if (!database->read()->get(kDescriptionKey)) return nullptr;
  return database;
}

MapDescription describeMap(Database& database) { return describe(database, *database.read()); }

LoadedMap loadMap(Database& database, BlockMap& map) {
  const std::unique_ptr<DatabaseReader> reader = database.read();
  LoadedMap loaded{describe(database, *reader), {}, {}};
  const std::string name = database.name();
  check(!loaded.description.submaps.empty(), name + " is damaged: it has no submap");
  check(loaded.description.camera.valid(), name + " is damaged: its camera is none");
  checkFits(loaded.description, map, name);
  const SubmapDescription& submap = loaded.description.submaps.front();
  const Window window = windowFor(submap, map);
  const std::vector<LayerContents> layers = readLayers(database, *reader, loaded.description, map);
  check(!layers.empty() && blockCount(layers.front()) == submap.blocks,
        name + " is damaged: it does not have the blocks that it says");
  checkRoom(layers.front(), window, map, name);
  reader->forEach(keyframePrefix(submap.id), [&](const std::string& key, const std::string& value) {
    loaded.keyframes.push_back(
        std::make_shared<const Keyframe>(parseKeyframe(value, rowName(database, key))));
    loaded.keyframe_numbers.push_back(numberOfKey(key));
  });
  map.resetAt(window.origin);
  fill(map, layers);
  return loaded;
}

}  // namespace depth_fusion
