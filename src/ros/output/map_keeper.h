// Keeps a live map: saves it on demand, from time to time and in the end, and loads it.
#pragma once

#include <depth_fusion/LoadMap.h>
#include <depth_fusion/SaveMap.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "depth_fusion/submaps/map_file.h"
#include "ros/callbacks/callback_gate.h"
#include "ros/in_process/frame_mapper.h"
#include "ros/output/map_commands.h"
#include "ros/output/map_keeper_parameters.h"

namespace depth_fusion {

// All of it runs in a thread of its own, beside mapping, which stands still only while the map is copied or
// replaced.
class MapKeeper {
 public:
  // Offers the services save_map and load_map in the handle's namespace. Keeps references.
  MapKeeper(std::shared_ptr<SharedMap> map, FrameMapper& mapper, const MapKeeperParameters& parameters,
            ros::NodeHandle handle, AnnounceMap announce);
  // Saves the map to map_file if it is kept there.
  ~MapKeeper();

  // Loads the map of map_file, if there is one. One that cannot be loaded is said to be so, and left alone.
  void loadAtStart();
  // The map of that generation goes on as another one, which belongs in map_file as it did. From the thread
  // of queue().
  void follow(uint32_t old_generation, uint32_t generation);
  // This object works in a thread of its own, which calls what stands in this queue.
  ros::CallbackQueue& queue() { return queue_; }
  // Where that path of a service means; empty: map_file. Throws Error for none.
  std::string placeOf(const std::string& path) const;
  // From any thread: adds what is to be said, and warns of what is not saved.
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  void loadKept();
  // Frames are neither tracked nor fused.
  void pause();
  bool isKeptAt(const std::string& place) const;
  // Nothing if only changes were to be saved, and there are none.
  std::optional<SaveReport> save(const std::string& place, bool only_changes);
  LoadedMap load(const std::string& place, Database& stored, bool read_only);
  // Saves to map_file what belongs there.
  void saveKept();
  // Whether the map, which is not empty, belongs in map_file.
  bool isKept();

  bool serveSave(SaveMap::Request& request, SaveMap::Response& response);
  bool serveLoad(LoadMap::Request& request, LoadMap::Response& response);
  void note(const std::string& problem, const std::string& news);

  const std::shared_ptr<SharedMap> map_;
  FrameMapper& mapper_;
  const MapKeeperParameters parameters_;
  const AnnounceMap announce_;
  std::unique_ptr<MapSaver> saver_;  // to the place of the last save or load
  std::string place_;                // of it
  uint32_t kept_generation_ = 0;     // of the map that belongs in map_file; 0: none does

  std::mutex status_mutex_;  // of the two that follow
  std::string problem_;
  std::string news_;  // of the last save or load

  ros::CallbackQueue queue_;
  CallbackGate callbacks_;
  ros::ServiceServer save_server_, load_server_;
  ros::WallTimer timer_;
  std::unique_ptr<ros::AsyncSpinner> spinner_;
};

}  // namespace depth_fusion
