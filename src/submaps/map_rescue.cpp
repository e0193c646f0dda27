#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "depth_fusion/common/error.h"
#include "depth_fusion/submaps/map_check.h"
#include "store/lmdb_damage.h"
#include "submaps/description_rows.h"
#include "submaps/keyframe_rows.h"
#include "submaps/layer_rows.h"
#include "submaps/row_keys.h"

namespace depth_fusion {
namespace {

// What can be reached of a map that may not even be opened.
RowSource salvagedRows(const std::string& location) {
  if (!isOnServer(location)) {
    return [=](const std::string& prefix, const DatabaseReader::Visit& visit) {
      salvageLmdb(location, prefix, visit);
    };
  }
  const std::shared_ptr<DatabaseReader> reader = openDatabase(location, DatabaseAccess::kRead)->read();
  return
      [=](const std::string& prefix, const DatabaseReader::Visit& visit) { reader->forEach(prefix, visit); };
}

class Rescue {
 public:
  Rescue(RowSource rows, DatabaseWriter& writer) : rows_(std::move(rows)), writer_(writer) {}

  MapRescue run() {
    writer_.put(kDescriptionKey, descriptionRow(description()));
    for (const SubmapDescription& submap : submaps()) {
      saveSubmap(submap);
      saveKeyframes(submap.id);
    }
    writer_.commit();
    return std::move(result_);
  }

 private:
  const MapDescription& description() {
    rows_(kDescriptionKey, [&](const std::string&, const std::string& row) {
      description_ = parseDescription(row, "the map's description");
    });
    check(description_.has_value(), "nothing can be saved: the map's description cannot be read");
    description_->revision++;
    return *description_;
  }

  std::vector<SubmapDescription> submaps() {
    std::vector<SubmapDescription> submaps;
    rows_(kSubmapPrefix, [&](const std::string& key, const std::string& row) {
      attempt([&] { submaps.push_back(parseSubmap(row, "row " + readable(key))); });
    });
    check(!submaps.empty(), "nothing can be saved: no submap's description can be read");
    return submaps;
  }

  void saveSubmap(SubmapDescription submap) {
    const uint64_t expected = std::exchange(submap.blocks, 0);
    const std::vector<LayerRow> layers = storedLayers(*description_);
    const GroupBlocks first = saveFirst(submap.id, layers.front());
    for (size_t i = 1; i < layers.size(); ++i) saveOther(submap.id, layers[i], first);
    for (const auto& [index, blocks] : first) submap.blocks += blocks.size();
    writer_.put(submapKey(submap.id), submapRow(submap));
    result_.blocks += submap.blocks;
    result_.blocks_lost += expected - std::min(expected, submap.blocks);
  }

  // Blocks are there if their first layer is.
  GroupBlocks saveFirst(uint32_t submap, const LayerRow& layer) {
    GroupBlocks groups;
    forEachGroup(
        rows_, submap, layer, blockSizeOf(*description_), result_.problems,
        [&](const std::string& key, const std::string& row, const BlockIndex& index, BlockGroup group) {
          writer_.put(key, row);
          groups[index] = std::move(group.blocks);
        });
    return groups;
  }

  // What another layer lacks of them is cleared.
  void saveOther(uint32_t submap, const LayerRow& layer, GroupBlocks missing) {
    const int block_size = blockSizeOf(*description_);
    forEachGroup(rows_, submap, layer, block_size, result_.problems,
                 [&](const std::string& key, const std::string& row, const BlockIndex& index,
                     const BlockGroup& group) {
                   const auto place = missing.find(index);
                   if (place == missing.end() || place->second != group.blocks) return;
                   writer_.put(key, row);
                   missing.erase(place);
                 });
    for (const auto& [index, blocks] : missing)
      writer_.put(blocksKey(submap, layer.name, index),
                  blocksRow(clearedGroup(blocks, layer, block_size), index, layer, block_size));
  }

  void saveKeyframes(uint32_t submap) {
    rows_(keyframePrefix(submap), [&](const std::string& key, const std::string& row) {
      if (!attempt([&] { parseKeyframe(row, "row " + readable(key)); })) return;
      writer_.put(key, row);
      ++result_.keyframes;
    });
  }

  // Whether it could be done; why not, is noted.
  template <class Action>
  bool attempt(const Action& action) {
    try {
      action();
      return true;
    } catch (const Error& error) {
      result_.problems.emplace_back(error.what());
      return false;
    }
  }

  RowSource rows_;
  DatabaseWriter& writer_;
  std::optional<MapDescription> description_;
  MapRescue result_;
};

}  // namespace

MapRescue rescueMap(const std::string& damaged, const std::string& rescued) {
  const std::unique_ptr<Database> target = openDatabase(rescued, DatabaseAccess::kWrite);
  target->read()->forEach("", [&](const auto&, const auto&) {
    throw Error(target->name() + " holds something already; choose another place");
  });
  return Rescue(salvagedRows(damaged), *target->write()).run();
}

}  // namespace depth_fusion
