// The status messages of tracking and fusion, and what diagnostics say of them.
#pragma once

#include <depth_fusion/MapStatus.h>
#include <depth_fusion/TrackerStatus.h>
#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include "depth_fusion/icp_tracking/icp_tracker.h"
#include "depth_fusion/map/block_map.h"
#include "depth_fusion/submaps/map_description.h"
#include "depth_fusion/submaps/store_usage.h"

namespace depth_fusion {

TrackerStatus makeTrackerStatus(const std_msgs::Header& header, const TrackingResult& result);
void setUsage(MapStatus& status, const BlockMap::Usage& usage);
void setUsage(MapStatus& status, const std::vector<SubmapDescription>& submaps, const StoreUsage& store);

// Set level, summary and values. `problem` hinders frames before they get that far; empty if nothing does.
// `advice`: what to do if the frame is lost.
void diagnose(const TrackerStatus& tracker, const std::string& problem, const std::string& advice,
              diagnostic_updater::DiagnosticStatusWrapper& status);
void diagnose(const MapStatus& map, const std::string& problem,
              diagnostic_updater::DiagnosticStatusWrapper& status);

}  // namespace depth_fusion
