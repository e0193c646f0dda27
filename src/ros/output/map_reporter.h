// What tsdf_fusion says of its map: answers to the tracker, the map's status, and pictures of it.
#pragma once

#include <depth_fusion/MapStatus.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "ros/callbacks/callback_gate.h"
#include "ros/in_process/frame_mapper.h"
#include "ros/output/model_picture.h"
#include "ros/output/submap_markers.h"
#include "ros/output/view_frame.h"

namespace depth_fusion {

// Reports are made in SharedMap::locked; diagnose() may be called at any time.
class MapReporter {
 public:
  // Publishes in the nodelet's namespace, and sends view_frame unless it is empty. A tracker that comes is
  // to be told of the map: `greet` is called then.
  MapReporter(const std::shared_ptr<SharedMap>& map, ros::NodeHandle& handle, const std::string& view_frame,
              const CallbackGate& callbacks, const std::function<void()>& greet);

  bool hasViewers() const { return view_publisher_.getNumSubscribers() > 0 || picture_.hasViewers(); }
  // The answer to the tracker for the frame of that header.
  void answer(const std_msgs::Header& header, const MappingOutcome& outcome, const FrameMapper& mapper,
              FusedMap& map);
  void publishStatus(const std_msgs::Header& header, const MappingOutcome& outcome, const FrameMapper& mapper,
                     FusedMap& map, const FrameAccount& frames);
  // Tells tracker and users of what no frame brought about: without a stamp.
  void announce(const std::string& news, const FrameMapper& mapper, FusedMap& map,
                const FrameAccount& frames);
  // Shows viewers the map as the frame's camera sees it; the renderer has that view.
  void show(const TrackedFrame& frame, ModelViewRenderer& renderer, const ModelPictureParameters& parameters,
            StageTimers& timers);
  // The level and summary of the last status; `problem` is of what the frames come from.
  void diagnose(const std::string& problem, diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  std::weak_ptr<SharedMap> map_;
  ros::Publisher view_publisher_, status_publisher_;
  ModelPicture picture_;
  SubmapMarkers submap_markers_;
  std::optional<ViewFrame> view_frame_;

  std::mutex mutex_;
  MapStatus status_;  // the last one
};

}  // namespace depth_fusion
