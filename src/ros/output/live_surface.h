// What viewers are shown of a map's surface while it grows.
#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "depth_fusion/surface_mesh/mesh_chunks.h"
#include "ros/conversions/surface_points.h"
#include "ros/in_process/shared_map.h"
#include "ros/output/byte_budget.h"
#include "ros/output/live_surface_parameters.h"
#include "ros/output/marker_traffic.h"

namespace depth_fusion {

// Who looks at the surface now.
struct SurfaceViewers {
  bool of_markers = false, of_points = false;
  bool took_all = true;  // no markers wait any more to be taken by a viewer
};

// Follows one map, chunk by chunk. For one thread; the map may change meanwhile.
class LiveSurface {
 public:
  LiveSurface(const std::shared_ptr<SharedMap>& map, const LiveSurfaceParameters& live,
              const SurfaceMeshParameters& mesh);

  bool follows(const std::shared_ptr<SharedMap>& map) const { return map_.lock() == map; }
  // All chunks count as changed, for viewers that come late.
  void showAll();
  // Takes the next chunks that changed, those near the camera first. The first time and after a reset the
  // markers begin with a DELETEALL. Without viewers of markers there are no markers; without viewers of
  // points points() has none. It ends when the budget is spent. While more has changed than fits, chunks are
  // simplified; they come again whole when there is room.
  visualization_msgs::MarkerArrayPtr update(const SurfaceViewers& viewers, ByteBudget& budget);
  // Viewers may lack these; they come again when nothing else has changed and the viewers have taken all.
  void noteLost(const MarkerTraffic::Lost& lost);
  // Whether points() is another than at the last call.
  bool pointsChanged() { return std::exchange(points_changed_, false); }
  // The points of all the chunks taken so far, as makeSurfacePoints gives them.
  boost::shared_ptr<SurfacePoints> points(const std_msgs::Header& header,
                                          const Eigen::Vector3d& sensor_W) const;

 private:
  // Whether the map was reset since the last time.
  bool beginAnew(SharedMap& map);
  void refresh();
  // If nothing else has changed, a chunk that is shown coarse is to be taken again.
  void noteCoarse();
  // If nothing else is to be taken at all, one that viewers may lack is. Returns the deletion of those before
  // it that have no surface any more.
  std::vector<visualization_msgs::Marker> noteLacking(const std::string& frame_id);
  std::vector<MeshChunk> takeChunk(SharedMap& map);
  visualization_msgs::Marker markerOf(const std::string& frame_id, const MeshChunk& chunk, double left_bytes);
  // The part of the chunk's triangles that its marker keeps.
  double shareOf(const MeshChunk& chunk, double left_bytes) const;
  // The same where there is room for all that changes.
  double wholeShare() const;
  void keepPoints(const MeshChunk& chunk);

  LiveSurfaceParameters parameters_;
  std::weak_ptr<SharedMap> map_;
  std::unique_ptr<MeshChunks> chunks_;  // for whoever has the map locked, as far as it reads the map
  uint32_t generation_ = 0;             // of the map shown; 0: none yet
  std::map<MeshChunkIndex, int> marker_ids_;
  std::vector<MeshChunkIndex> marked_;  // the chunks, by the ids of their markers
  std::map<MeshChunkIndex, TriangleMesh> points_;
  bool points_changed_ = true;
  std::set<MeshChunkIndex> coarse_;  // chunks shown with fewer triangles than they should have
  std::set<int> lacking_;            // markers that some viewer may not have as they are
  size_t left_of_round_ = 0;         // chunks that changed, and were sorted by their distance
};

}  // namespace depth_fusion
