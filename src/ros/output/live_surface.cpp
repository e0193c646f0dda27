#include "ros/output/live_surface.h"

#include <boost/make_shared.hpp>

#include "depth_fusion/surface_mesh/simplification.h"
#include "ros/conversions/surface_messages.h"

namespace depth_fusion {

using visualization_msgs::MarkerArray;
using visualization_msgs::MarkerArrayPtr;

LiveSurface::LiveSurface(const std::shared_ptr<SharedMap>& map, const LiveSurfaceParameters& live,
                         const SurfaceMeshParameters& mesh)
    : parameters_(live), map_(map) {
  map->locked([&](FusedMap& fused) {
    chunks_ = std::make_unique<MeshChunks>(*map->compute, fused.map(), mesh, live.chunk_blocks);
  });
}

void LiveSurface::showAll() {
  const std::shared_ptr<SharedMap> map = map_.lock();
  if (map == nullptr) return;
  map->locked([this](FusedMap&) { chunks_->noteAll(); });
}

MarkerArrayPtr LiveSurface::update(bool with_markers, bool with_points) {
  const auto markers = boost::make_shared<MarkerArray>();
  const std::shared_ptr<SharedMap> map = map_.lock();
  if (map == nullptr) return markers;
  if (beginAnew(*map) && with_markers) markers->markers.push_back(makeDeletionOfAll(map->frame_id));
  if (!with_points) points_.clear();
  if (with_markers) refresh();
  for (int i = 0; i < parameters_.chunks_per_update; ++i) {
    for (const MeshChunk& chunk : takeChunk(*map)) {
      if (with_markers) markers->markers.push_back(markerOf(map->frame_id, chunk));
      if (with_points) keepPoints(chunk);
    }
  }
  return markers;
}

bool LiveSurface::beginAnew(SharedMap& map) {
  map.locked([this](FusedMap&) { chunks_->follow(); });
  if (generation_ == chunks_->generation()) return false;
  generation_ = chunks_->generation();
  marker_ids_.clear();
  points_.clear();
  return true;
}

void LiveSurface::refresh() {
  const size_t room = static_cast<size_t>(parameters_.chunks_per_update);
  if (chunks_->changedCount() < room)
    chunks_->noteNext(std::min<size_t>(parameters_.refresh_chunks, room - chunks_->changedCount()));
}

// One at a time, so that mapping never waits for more.
std::vector<MeshChunk> LiveSurface::takeChunk(SharedMap& map) {
  return map.locked([this](FusedMap& fused) {
    return generation_ == fused.map().generation() ? chunks_->takeChanged(1) : std::vector<MeshChunk>();
  });
}

visualization_msgs::Marker LiveSurface::markerOf(const std::string& frame_id, const MeshChunk& chunk) {
  const int id = marker_ids_.emplace(chunk.index, static_cast<int>(marker_ids_.size())).first->second;
  if (chunk.mesh.triangles.empty()) return makeDeletion(frame_id, id);
  return makeSurfaceMarker(frame_id, id,
                           simplified(chunk.mesh, parameters_.triangle_share, OpenBorders::kStay));
}

void LiveSurface::keepPoints(const MeshChunk& chunk) {
  if (chunk.mesh.triangles.empty()) {
    points_.erase(chunk.index);
  } else {
    points_[chunk.index] = thinned(chunk.mesh, parameters_.point_spacing_m);
  }
}

sensor_msgs::PointCloud2Ptr LiveSurface::points(const std_msgs::Header& header) const {
  std::vector<const TriangleMesh*> meshes;
  for (const auto& entry : points_) meshes.push_back(&entry.second);
  return boost::make_shared<sensor_msgs::PointCloud2>(makePointCloud(header, meshes));
}

}  // namespace depth_fusion
