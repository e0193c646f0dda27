// All that a user can have done with a live map: commands, saving and loading, loops and refinement.
#pragma once

#include <memory>

#include "ros/output/map_commands.h"
#include "ros/output/map_keeper.h"
#include "ros/output/map_refiner.h"

namespace depth_fusion {

class MapServices {
 public:
  // Loads the map that is kept, if there is one, and offers the services in the handle's namespace. Keeps a
  // reference to the mapper.
  MapServices(const std::shared_ptr<SharedMap>& map, FrameMapper& mapper, const MapKeeperParameters& kept,
              const MapRefinerParameters& refined, const ros::NodeHandle& handle,
              const CallbackGate& callbacks, const AnnounceMap& announce)
      : keeper_(map, mapper, kept, handle, announce) {
    keeper_.loadAtStart();
    refiner_ = std::make_unique<MapRefiner>(map, mapper, refined, keeper_, handle, announce);
    commands_ = std::make_unique<MapCommands>(map, mapper, handle, callbacks, announce);
  }

  // From any thread.
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
    keeper_.diagnose(status);
    refiner_->diagnose(status);
  }

 private:
  MapKeeper keeper_;  // saves the map in the end, when the others are gone
  std::unique_ptr<MapRefiner> refiner_;
  std::unique_ptr<MapCommands> commands_;
};

}  // namespace depth_fusion
