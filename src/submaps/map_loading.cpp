#include <algorithm>
#include <utility>

#include "depth_fusion/common/error.h"
#include "depth_fusion/submaps/map_file.h"
#include "submaps/block_store.h"
#include "submaps/description_rows.h"
#include "submaps/keyframe_rows.h"
#include "submaps/row_keys.h"

namespace depth_fusion {
namespace {

std::string rowName(const Database& database, const std::string& key) {
  return database.name() + ", row " + readable(key) + ",";
}

// The window that the map had, or one of another size about the same blocks.
Window windowFor(const SubmapDescription& submap, int n) {
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

ReadMap::ReadMap(Database& database, const SubmapCollection& submaps)
    : block_size_(submaps.map().parameters().block_size) {
  const std::unique_ptr<DatabaseReader> reader = database.read();
  loaded_.description = describeMap(database, *reader);
  const MapDescription& stored = loaded_.description;
  MapParameters parameters = submaps.map().parameters();
  for (const char* parameter : kVoxelParameters)
    checkSameParameter(stored, parameter, withPrefix("map", parameters.table()), database.name());
  const std::vector<LayerRow> layers = layersOf(parameters);
  store_ = std::make_unique<BlockStore>(submaps.parameters_, layers, block_size_);
  for (const SubmapDescription& submap : stored.submaps) readSubmap(database, *reader, submap.id, layers);
  checkSubmaps(database.name());
  reader->forEach(keyframePrefix(0), [&](const std::string& key, const std::string& value) {
    loaded_.keyframes.push_back(
        std::make_shared<const Keyframe>(parseKeyframe(value, rowName(database, key))));
    loaded_.keyframe_numbers.push_back(numberOfKey(key));
  });
}

ReadMap::~ReadMap() = default;

void ReadMap::readSubmap(const Database& database, DatabaseReader& reader, uint32_t submap,
                         const std::vector<LayerRow>& layers) {
  const std::string prefix = blocksPrefix(submap, layers.front().name);
  reader.forEach(prefix, [&](const std::string& key, const std::string& row) {
    const BlockIndex index = groupOfKey(key, prefix);
    const BlockGroup first = parseBlocks(row, index, layers.front(), block_size_, rowName(database, key));
    GroupRows rows = {row};
    for (size_t i = 1; i < layers.size(); ++i)
      rows.push_back(otherRow(database, reader, submap, layers[i], index, first.blocks));
    loaded_.groups[index][submap] = first.blocks.size();
    store_->putRows({submap, index}, std::move(rows), first.blocks.size());
  });
}

std::string ReadMap::otherRow(const Database& database, DatabaseReader& reader, uint32_t submap,
                              const LayerRow& layer, const BlockIndex& index,
                              const std::vector<BlockIndex>& blocks) const {
  const std::vector<std::string>& stored = loaded_.description.layers;
  if (std::count(stored.begin(), stored.end(), layer.name) == 0)
    return blocksRow(clearedGroup(blocks, layer, block_size_), index, layer, block_size_);
  const std::string key = blocksKey(submap, layer.name, index);
  const std::optional<std::string> row = reader.get(key);
  const bool is_there =
      row && parseBlocks(*row, index, layer, block_size_, rowName(database, key)).blocks == blocks;
  check(is_there,
        database.name() + " is damaged: its layer " + layer.name + " has other blocks than the first");
  return *row;
}

void ReadMap::checkSubmaps(const std::string& name) const {
  const std::vector<SubmapDescription>& submaps = loaded_.description.submaps;
  std::vector<uint64_t> blocks(submaps.size(), 0);
  for (const auto& [group, counts] : loaded_.groups) {
    for (const auto& [submap, count] : counts) blocks.at(submap) += count;
  }
  check(loaded_.description.active_submap < submaps.size(), name + " is damaged: it lacks a submap");
  for (size_t i = 0; i < submaps.size(); ++i)
    check(submaps[i].id == i && submaps[i].blocks == blocks[i],
          name + " is damaged: it does not have the blocks that it says");
}

void ReadMap::moveTo(SubmapCollection& submaps) {
  const MapDescription& description = loaded_.description;
  std::vector<SubmapCollection::GroupSizes> stored(description.submaps.size());
  for (const auto& [group, counts] : loaded_.groups) {
    for (const auto& [submap, count] : counts) stored[submap][group] = count;
  }
  const int n = submaps.map().parameters().blocks_per_axis;
  submaps.adopt(description, std::move(stored), std::move(store_),
                windowFor(description.submaps[description.active_submap], n));
}

}  // namespace depth_fusion
