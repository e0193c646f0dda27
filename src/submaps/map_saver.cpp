#include <algorithm>
#include <chrono>
#include <random>
#include <utility>

#include "depth_fusion/common/error.h"
#include "depth_fusion/submaps/map_file.h"
#include "submaps/block_rows.h"
#include "submaps/description_rows.h"
#include "submaps/keyframe_rows.h"
#include "submaps/row_keys.h"
#include "submaps/whole_map.h"

namespace depth_fusion {
namespace {

constexpr char kSoftware[] = "depth_fusion 0.1.0";
constexpr uint32_t kKeyframes = 0;  // they are all in one list

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

MapSaver::MapSaver(std::string location) : location_(std::move(location)) {}

MapSaver::MapSaver(std::shared_ptr<Database> database) : database_(std::move(database)) {}

MapSaver::~MapSaver() = default;

void MapSaver::capture(SubmapCollection& submaps, const MapDescription& description,
                       const Keyframes& keyframes) {
  BlockMap& map = submaps.map();
  if (!changes_ || map.generation() != generation_) {
    changes_ = map.follow();
    generation_ = map.generation();
    everything_changed_ = true;
  }
  const MapChanges changes = changes_->take();
  everything_changed_ = everything_changed_ || changes.complete;
  const int edge = groupEdge(map.parameters().block_size);
  for (const auto* blocks : {&changes.updated, &changes.released, &changes.evicted}) {
    for (const BlockIndex& block : *blocks) changed_groups_.insert(groupOf(block, edge));
  }
  captured_ = Capture();
  captured_->description = description;
  captured_->description.layers = namesOf(layersOf(map.parameters()));
  captured_->description.submaps = submaps.submaps();
  captured_->description.active_submap = submaps.active();
  captured_->description.way_m = submaps.way_m();
  captured_->blocks = std::make_unique<WholeMap>(submaps, everything_changed_ ? nullptr : &changed_groups_);
  captured_->keyframes = keyframes;
  captured_->everything = everything_changed_;
}

bool MapSaver::isWritten(DatabaseReader& stored) const {
  const std::optional<std::string> row = stored.get(kDescriptionKey);
  if (!row || revision_ == 0) return false;
  const MapDescription description = parseDescription(*row, "the map that is stored there");
  return description.id == id_ && description.revision == revision_;
}

void MapSaver::adopt(SubmapCollection& submaps, const LoadedMap& stored) {
  BlockMap& map = submaps.map();
  changes_ = map.follow();
  changes_->take();
  generation_ = map.generation();
  everything_changed_ = namesOf(layersOf(map.parameters())) != stored.description.layers;
  changed_groups_.clear();
  id_ = stored.description.id;
  revision_ = stored.description.revision;
  written_groups_ = stored.groups;
  written_keyframes_.clear();
  for (size_t i = 0; i < stored.keyframes.size(); ++i)
    written_keyframes_[stored.keyframes[i]] = stored.keyframe_numbers[i];
}

void MapSaver::prepare() {
  if (database_ == nullptr || (!location_.empty() && !database_->isThere()))
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
  SaveReport report{database_->name(), 0, 0, 0, 0};
  StoredGroups groups = writeBlocks(*writer, report);
  writeSubmaps(*writer, groups, report);
  WrittenKeyframes keyframes = writeKeyframes(*writer, all);
  writer->commit();
  everything_changed_ = false;
  changed_groups_.clear();
  written_groups_ = std::move(groups);
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

StoredGroups MapSaver::writeBlocks(DatabaseWriter& writer, SaveReport& report) const {
  WholeMap& blocks = *captured_->blocks;
  const auto forEachKey = [&](const BlockIndex& group, uint32_t submap, const auto& function) {
    for (size_t i = 0; i < blocks.layers().size(); ++i)
      function(blocksKey(submap, blocks.layers()[i].name, group), i);
  };
  StoredGroups stored = captured_->everything ? StoredGroups() : written_groups_;
  for (const BlockIndex& group : changed_groups_) {
    const auto before = stored.find(group);
    if (before == stored.end()) continue;
    for (const auto& [submap, count] : before->second)
      forEachKey(group, submap, [&](const std::string& key, size_t) { writer.erase(key); });
    stored.erase(before);
  }
  for (const auto& [group, submaps] : blocks.groups()) {
    for (const auto& [submap, count] : submaps) {
      const std::vector<std::string> rows = blocks.rows({submap, group});
      forEachKey(group, submap, [&](const std::string& key, size_t i) { writer.put(key, rows[i]); });
      report.blocks_written += count;
    }
    stored[group] = submaps;
  }
  return stored;
}

void MapSaver::writeSubmaps(DatabaseWriter& writer, const StoredGroups& stored, SaveReport& report) const {
  std::vector<SubmapDescription> submaps = captured_->description.submaps;
  for (SubmapDescription& submap : submaps) submap.blocks = 0;
  for (const auto& [group, counts] : stored) {
    for (const auto& [submap, count] : counts) submaps.at(submap).blocks += count;
  }
  for (const SubmapDescription& submap : submaps) {
    writer.put(submapKey(submap.id), submapRow(submap));
    report.blocks += submap.blocks;
  }
  report.submaps = static_cast<uint32_t>(submaps.size());
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
    if (!is_there) writer.put(keyframeKey(kKeyframes, written[keyframe]), keyframeRow(*keyframe));
  }
  if (all) return written;
  for (const auto& [keyframe, number] : written_keyframes_) {
    if (written.count(keyframe) == 0) writer.erase(keyframeKey(kKeyframes, number));
  }
  return written;
}

}  // namespace depth_fusion
