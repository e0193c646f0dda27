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

namespace depth_fusion {

// What a stored map holds beside its blocks.
struct LoadedMap {
  MapDescription description;
  Keyframes keyframes;
  std::vector<uint32_t> keyframe_numbers;  // in their rows
};

// What a save wrote, and what is there now.
struct SaveReport {
  std::string place;            // for messages
  uint64_t blocks = 0;          // of the map
  uint64_t blocks_written = 0;  // those that had changed, and their neighbours
  uint64_t bytes = 0;           // of the whole map where it lies
};

// Saves a map at one place: all of it the first time, what has changed since later. Others see each save as a
// whole.
class MapSaver {
 public:
  // The place is as openDatabase has it.
  explicit MapSaver(std::string location) : location_(std::move(location)) {}

  // The map is the one that is stored there: saves write what changes from now on.
  void adopt(BlockMap& map, const LoadedMap& stored);
  // Looks at what is stored, to know whether all of the map is to be written there: before capture(). Throws
  // Error if nothing can be written there.
  void prepare();
  // Keeps what has changed of the map, as it is now, for write(); whoever calls it holds what guards the map.
  // Of the description, the caller gives parameters, camera and last pose.
  void capture(BlockMap& map, const MapDescription& description, const Keyframes& keyframes);
  // Writes what was captured last. Throws Error if it cannot be written; what is stored is then as it was,
  // and the next save makes up for it.
  SaveReport write();
  // Whether what was captured last is another map than the one that is stored.
  bool hasChanges() const;

 private:
  // What is to be written.
  struct Capture {
    MapDescription description;
    SubmapDescription submap;
    int block_size = 0;
    std::vector<LayerRow> layers;
    std::vector<SlotTable::Block> blocks;  // in the order of their slots, and so are the next two
    std::string states;                    // an int each
    std::vector<std::string> voxels;       // of each layer
    Keyframes keyframes;
    bool everything = false;
  };

  using WrittenKeyframes = std::map<KeyframePtr, uint32_t>;  // with their numbers

  // Whether what is stored is what this saver wrote last.
  bool isWritten(DatabaseReader& stored) const;
  // Copies the blocks of the groups that changed.
  void copyBlocks(BlockMap& map);
  void writeBlocks(DatabaseWriter& writer) const;
  // A row of each layer of the blocks at these places of the capture; none if there is no block.
  void writeGroup(DatabaseWriter& writer, const BlockIndex& index, const std::vector<size_t>& places) const;
  WrittenKeyframes writeKeyframes(DatabaseWriter& writer, bool all) const;

  std::string location_;
  std::unique_ptr<Database> database_;  // null before it is needed
  std::optional<MapSubscription> changes_;
  uint32_t generation_ = 0;  // of the map that changes_ is of
  std::optional<Capture> captured_;
  bool everything_changed_ = true;
  std::set<BlockIndex, BlockOrder> changed_groups_;  // since what is stored
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
  // Reads the map for one with the parameters and the pool of `map`, of which nothing else is looked at.
  // Throws Error if the two do not fit together, or if what is stored is damaged.
  ReadMap(Database& database, const BlockMap& map);

  // Fills the map; what it held before is gone.
  void moveTo(BlockMap& map) const;
  const LoadedMap& loaded() const { return loaded_; }

 private:
  // A layer's blocks, in the order of their rows, and their voxels.
  struct Layer {
    LayerRow row;
    std::vector<BlockIndex> blocks;
    std::vector<int> states;
    std::string voxels;
  };

  void readLayer(const Database& database, DatabaseReader& reader, const LayerRow& row, int block_size);
  void checkRoom(const BlockMap& map, const std::string& name) const;

  LoadedMap loaded_;
  Window window_;
  std::vector<Layer> layers_;  // those that both maps have, the TSDF first
};

}  // namespace depth_fusion
