// Loops of a live map: they are sought beside tracking, and where they move poses, the map is made anew from
// its keyframes, also beside it, and takes its own place.
#pragma once

#include <depth_fusion/RefineMap.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "depth_fusion/pipeline/map_refinement.h"
#include "ros/callbacks/callback_gate.h"
#include "ros/in_process/frame_mapper.h"
#include "ros/output/map_commands.h"
#include "ros/output/map_keeper.h"
#include "ros/output/map_refiner_parameters.h"

namespace depth_fusion {

// All of it runs in the keeper's thread, so that a map is not saved while it is replaced.
class MapRefiner {
 public:
  // Offers the service refine_map in the handle's namespace, and says there what becomes of loops. Keeps
  // references.
  MapRefiner(std::shared_ptr<SharedMap> map, FrameMapper& mapper, const MapRefinerParameters& parameters,
             MapKeeper& keeper, ros::NodeHandle handle, AnnounceMap announce);
  ~MapRefiner();

  // From any thread.
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  // Follows the map, says what became of loops, and replaces the map where they have moved it.
  void look();
  // Has loops sought in the map that there is now, if it is another one, unless a part of it was loaded.
  void follow();
  void publish(const std::vector<LoopCandidate>& candidates);
  bool serve(RefineMap::Request& request, RefineMap::Response& response);
  // Fuses the keyframes, those that come meanwhile among them, and returns where they were by then.
  Corrections fuse(MapRefinement& refinement);
  // Fuses what the sensor sees now: frames are left out of the keyframes while too many wait, and tracking
  // has to go on from there.
  void fuseLastView(MapRefinement& refinement, const Corrections& corrections);
  Corrections replace();
  Corrections saveTo(const std::string& place, float voxel_size_m);
  // Parameters for a map as there is now.
  PipelineParameters parametersNow() const;
  void note(const std::string& problem);

  const std::shared_ptr<SharedMap> map_;
  FrameMapper& mapper_;
  const MapRefinerParameters parameters_;
  MapKeeper& keeper_;
  const AnnounceMap announce_;
  const LoopParameters loops_parameters_;
  const std::unique_ptr<ComputeContext> queue_;
  uint32_t generation_ = 0;
  std::shared_ptr<LoopClosing> loops_;   // null where they are not sought
  double seen_move_m_ = 0.0;             // at the last look
  std::optional<double> failed_move_m_;  // that the map could not be made anew by

  std::mutex status_mutex_;  // of the one that follows
  std::string problem_;

  ros::Publisher publisher_;
  CallbackGate callbacks_;
  ros::ServiceServer server_;
  ros::WallTimer timer_;
};

}  // namespace depth_fusion
