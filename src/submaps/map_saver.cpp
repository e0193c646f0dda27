#include <algorithm>
#include <chrono>
#include <cstring>
#include <random>
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

constexpr char kSoftware[] = "depth_fusion 0.1.0";
constexpr uint32_t kSubmap = 0;  // the only one

uint64_t randomId() {
  std::random_device random;
  return (uint64_t{random()} << 32 | random()) | 1;
}

double unixTime_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::vector<std::string> namesOf(const std::vector<LayerRow>& layers) {
  std::vector<std::string> names;
  for (const LayerRow& layer : layers) names.push_back(layer.name);
  return names;
}

// Removes whatever map is stored. Throws Error if it is no map.
void removeMap(DatabaseWriter& writer, const std::string& name) {
  bool is_empty = true;
  if (!writer.get(kDescriptionKey)) writer.forEach("", [&](const auto&, const auto&) { is_empty = false; });
  check(is_empty, name + " holds something else than a map; choose another place");
  writer.clear();
}

}  // namespace

void MapSaver::capture(BlockMap& map, const MapDescription& description, const Keyframes& keyframes) {
  if (!changes_ || map.generation() != generation_) {
    changes_ = map.follow();
    generation_ = map.generation();
    everything_changed_ = true;
  }
  const MapChanges changes = changes_->take();
  everything_changed_ = everything_changed_ || changes.complete;
  const int edge = groupEdge(map.parameters().block_size);
  for (const auto* blocks : {&changes.updated, &changes.released}) {
    for (const BlockIndex& block : *blocks) changed_groups_.insert(groupOf(block, edge));
  }
  captured_ = Capture();
  captured_->description = description;
  captured_->keyframes = keyframes;
  captured_->everything = everything_changed_;
  copyBlocks(map);
}

void MapSaver::copyBlocks(BlockMap& map) {
  Capture& capture = *captured_;
  capture.block_size = map.parameters().block_size;
  capture.layers = layersOf(map.parameters());
  capture.submap = {kSubmap, Pose::Identity(), map.window(), map.slots().used()};
  const int edge = groupEdge(capture.block_size);
  std::vector<int> slots;
  for (int slot = 0; slot < map.slots().bound(); ++slot) {
    if (!map.slots().inUse(slot)) continue;
    const BlockIndex& block = map.slots().blockOf(slot);
    if (!everything_changed_ && changed_groups_.count(groupOf(block, edge)) == 0) continue;
    capture.blocks.push_back({block, slot});
    slots.push_back(slot);
  }
  capture.states = readSlots(map.blockStates(), slots, sizeof(int));
  capture.description.layers = namesOf(capture.layers);
  for (const LayerRow& layer : capture.layers)
    capture.voxels.push_back(
        readSlots(map.layer(layer.name), slots, layer.bytesPerBlock(capture.block_size)));
}

bool MapSaver::isWritten(DatabaseReader& stored) const {
  const std::optional<std::string> row = stored.get(kDescriptionKey);
  if (!row || revision_ == 0) return false;
  const MapDescription description = parseDescription(*row, "the map that is stored there");
  return description.id == id_ && description.revision == revision_;
}

void MapSaver::adopt(BlockMap& map, const LoadedMap& stored) {
  changes_ = map.follow();
  changes_->take();
  generation_ = map.generation();
  everything_changed_ = namesOf(layersOf(map.parameters())) != stored.description.layers;
  changed_groups_.clear();
  id_ = stored.description.id;
  revision_ = stored.description.revision;
  written_keyframes_.clear();
  for (size_t i = 0; i < stored.keyframes.size(); ++i)
    written_keyframes_[stored.keyframes[i]] = stored.keyframe_numbers[i];
}

void MapSaver::prepare() {
  if (database_ == nullptr || !database_->isThere())
    database_ = openDatabase(location_, DatabaseAccess::kWrite);
  everything_changed_ = everything_changed_ || !isWritten(*database_->read());
}

SaveReport MapSaver::write() {
  check(database_ != nullptr && captured_.has_value(), "no map was captured to be saved");
  const std::unique_ptr<DatabaseWriter> writer = database_->write();
  check(captured_->everything || isWritten(*writer),
        database_->name() + " holds another map by now; the next save replaces it");
  const bool all = captured_->everything;
  if (all) removeMap(*writer, database_->name());
  MapDescription& description = captured_->description;
  description.id = all ? randomId() : id_;
  description.revision = all ? 1 : revision_ + 1;
  description.saved_at_s = unixTime_s();
  description.software = kSoftware;
  writer->put(kDescriptionKey, descriptionRow(description));
  writer->put(submapKey(kSubmap), submapRow(captured_->submap));
  writeBlocks(*writer);
  WrittenKeyframes keyframes = writeKeyframes(*writer, all);
  writer->commit();
  SaveReport report{database_->name(), captured_->submap.blocks, captured_->blocks.size(), 0};
  everything_changed_ = false;
  changed_groups_.clear();
  written_keyframes_ = std::move(keyframes);
  id_ = description.id;
  revision_ = description.revision;
  captured_.reset();
  report.bytes = database_->bytes();
  return report;
}

bool MapSaver::hasChanges() const {
  check(captured_.has_value(), "no map was captured to be saved");
  if (captured_->everything || !changed_groups_.empty()) return true;
  return captured_->keyframes.size() != written_keyframes_.size() ||
         std::any_of(captured_->keyframes.begin(), captured_->keyframes.end(),
                     [this](const KeyframePtr& keyframe) { return written_keyframes_.count(keyframe) == 0; });
}

void MapSaver::writeBlocks(DatabaseWriter& writer) const {
  const Capture& capture = *captured_;
  const int edge = groupEdge(capture.block_size);
  std::map<BlockIndex, std::vector<size_t>, BlockOrder> groups;  // places of their blocks
  if (!capture.everything) {
    for (const BlockIndex& group : changed_groups_) groups[group] = {};
  }
  for (size_t place = 0; place < capture.blocks.size(); ++place)
    groups[groupOf(capture.blocks[place].index, edge)].push_back(place);
  for (auto& [index, places] : groups) {
    std::sort(places.begin(), places.end(),
              [&](size_t a, size_t b) { return before(capture.blocks[a].index, capture.blocks[b].index); });
    writeGroup(writer, index, places);
  }
}

void MapSaver::writeGroup(DatabaseWriter& writer, const BlockIndex& index,
                          const std::vector<size_t>& places) const {
  const Capture& capture = *captured_;
  BlockGroup group;
  for (const size_t place : places) {
    group.blocks.push_back(capture.blocks[place].index);
    int state = 0;
    std::memcpy(&state, &capture.states[place * sizeof(int)], sizeof(int));
    group.states.push_back(state);
  }
  for (size_t i = 0; i < capture.layers.size(); ++i) {
    const LayerRow& layer = capture.layers[i];
    const std::string key = blocksKey(kSubmap, layer.name, index);
    if (places.empty()) {
      writer.erase(key);
      continue;
    }
    const size_t bytes = layer.bytesPerBlock(capture.block_size);
    group.voxels.clear();
    for (const size_t place : places) group.voxels.append(capture.voxels[i], place * bytes, bytes);
    writer.put(key, blocksRow(group, index, layer, capture.block_size));
  }
}

MapSaver::WrittenKeyframes MapSaver::writeKeyframes(DatabaseWriter& writer, bool all) const {
  WrittenKeyframes written;
  uint32_t next = 0;
  if (!all) {
    for (const auto& [keyframe, number] : written_keyframes_) next = std::max(next, number + 1);
  }
  for (const KeyframePtr& keyframe : captured_->keyframes) {
    const auto known = written_keyframes_.find(keyframe);
    const bool is_there = !all && known != written_keyframes_.end();
    written[keyframe] = is_there ? known->second : next++;
    if (!is_there) writer.put(keyframeKey(kSubmap, written[keyframe]), keyframeRow(*keyframe));
  }
  if (all) return written;
  for (const auto& [keyframe, number] : written_keyframes_) {
    if (written.count(keyframe) == 0) writer.erase(keyframeKey(kSubmap, number));
  }
  return written;
}

}  // namespace depth_fusion
