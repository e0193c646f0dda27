// Maps in files and on servers: saved as they grow, and loaded.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "depth_fusion/map/block_map.h"
#include "depth_fusion/relocalisation/keyframe.h"
#include "depth_fusion/store/database.h"
#include "depth_fusion/submaps/map_description.h"
#include "depth_fusion/submaps/submap_collection.h"

namespace depth_fusion {

class WholeMap;

// The groups of blocks that are stored, with the number of their blocks in each submap.
using StoredGroups = std::map<BlockIndex, std::map<uint32_t, size_t>, BlockOrder>;

// What a stored map holds beside its blocks.
struct LoadedMap {
  MapDescription description;
  StoredGroups groups;
  Keyframes keyframes;
  std::vector<uint32_t> keyframe_numbers;  // in their rows
};

// What a save wrote, and what is there now.
struct SaveReport {
  std::string place;  // for messages
  uint32_t submaps = 0;
  uint64_t blocks = 0;          // of the map
  uint64_t blocks_written = 0;  // those that had changed, and their neighbours
  uint64_t bytes = 0;           // of the whole map where it lies
};

// Saves a map at one place: all of it the first time, what has changed since later. Others see each save as a
// whole.
class MapSaver {
 public:
  // The place is as openDatabase has it.
  explicit MapSaver(std::string location);
  // Saves there, wherever that is.
  explicit MapSaver(std::shared_ptr<Database> database);
  ~MapSaver();

  // The map is the one that is stored there: saves write what changes from now on.
  void adopt(SubmapCollection& submaps, const LoadedMap& stored);
  // Looks at what is stored, to know whether all of the map is to be written there: before capture(). Throws
  // Error if nothing can be written there.
  void prepare();
  // Keeps what has changed of the map, as it is now, for write(); whoever calls it holds what guards the map.
  // The caller gives parameters, camera and last pose of the description. Throws Error if what the pool does
  // not hold cannot be read.
  void capture(SubmapCollection& submaps, const MapDescription& description, const Keyframes& keyframes);
  // Writes what was captured last. Throws Error if it cannot be written; what is stored is then as it was,
  // and the next save makes up for it.
  SaveReport write();
  // Whether what was captured last is another map than the one that is stored.
  bool hasChanges() const;

 private:
  // What is to be written.
  struct Capture {
    MapDescription description;
    std::unique_ptr<WholeMap> blocks;  // of the groups that changed
    Keyframes keyframes;
    bool everything = false;
  };

  using WrittenKeyframes = std::map<KeyframePtr, uint32_t>;  // with their numbers

  // Whether what is stored is what this saver wrote last.
  bool isWritten(DatabaseReader& stored) const;
  // Return what is then stored.
  StoredGroups writeBlocks(DatabaseWriter& writer, SaveReport& report) const;
  void writeSubmaps(DatabaseWriter& writer, const StoredGroups& stored, SaveReport& report) const;
  WrittenKeyframes writeKeyframes(DatabaseWriter& writer, bool all) const;

  std::string location_;                // empty: the database was given
  std::shared_ptr<Database> database_;  // null before it is needed
  std::optional<MapSubscription> changes_;
  uint32_t generation_ = 0;  // of the map that changes_ is of
  std::optional<Capture> captured_;
  bool everything_changed_ = true;
  std::set<BlockIndex, BlockOrder> changed_groups_;  // since what is stored
  StoredGroups written_groups_;
  WrittenKeyframes written_keyframes_;
  uint64_t id_ = 0, revision_ = 0;  // of what this saver wrote last; 0: nothing
};

// The map at that place, to be read; null if there is none. Throws Error if it cannot be reached, and if what
// is there is damaged.
std::unique_ptr<Database> openStoredMap(const std::string& location);

// What the map at that place says of itself. Throws Error if there is none.
MapDescription describeMap(const Database& database, DatabaseReader& reader);
MapDescription describeMap(Database& database);

// A stored map that was read, to take another one's place.
class ReadMap {
 public:
  // Reads the map for one with the parameters of `submaps`, of which nothing else is looked at. Throws Error
  // if the two do not fit together, or if what is stored is damaged.
  ReadMap(Database& database, const SubmapCollection& submaps);
  ~ReadMap();

  // Fills the map, once; what it held before is gone.
  void moveTo(SubmapCollection& submaps);
  const LoadedMap& loaded() const { return loaded_; }

 private:
  void readSubmap(const Database& database, DatabaseReader& reader, uint32_t submap,
                  const std::vector<LayerRow>& layers);
  // The row of another layer of a group of these blocks: cleared ones where the map does not have the layer.
  std::string otherRow(const Database& database, DatabaseReader& reader, uint32_t submap,
                       const LayerRow& layer, const BlockIndex& index,
                       const std::vector<BlockIndex>& blocks) const;
  void checkSubmaps(const std::string& name) const;

  int block_size_;
  LoadedMap loaded_;
  std::unique_ptr<BlockStore> store_;
};

}  // namespace depth_fusion
