#include "ros/output/live_surface.h"

#include <boost/make_shared.hpp>

#include "depth_fusion/submaps/world_mesh.h"
#include "depth_fusion/surface_mesh/simplification.h"
#include "ros/conversions/surface_messages.h"

namespace depth_fusion {

namespace {

constexpr double kTriangleBytes = 120.0;  // of a marker: three corners of 24 bytes, and three colours of 16
constexpr double kCoarsest = 0.1;         // share of a chunk's triangles

}  // namespace

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;
using visualization_msgs::MarkerArrayPtr;

LiveSurface::LiveSurface(const std::shared_ptr<SharedMap>& map, const LiveSurfaceParameters& live,
                         const SurfaceMeshParameters& mesh)
    : parameters_(live), map_(map) {
  map->locked([&](FusedMap& fused) {
    chunks_ = std::make_unique<MeshChunks>(*map->compute, fused.map(), mesh, live.chunk_blocks);
    chunks_->lookElsewhere(std::make_unique<WorldParts>(*map->compute, fused.submaps()));
  });
}

void LiveSurface::showAll() {
  const std::shared_ptr<SharedMap> map = map_.lock();
  if (map == nullptr) return;
  map->locked([this](FusedMap&) { chunks_->noteAll(); });
}

MarkerArrayPtr LiveSurface::update(const SurfaceViewers& viewers, ByteBudget& budget) {
  const auto markers = boost::make_shared<MarkerArray>();
  const std::shared_ptr<SharedMap> map = map_.lock();
  if (map == nullptr) return markers;
  const auto add = [&](const Marker& marker) {
    markers->markers.push_back(marker);
    budget.spend(ros::serialization::serializationLength(marker));
  };
  if (beginAnew(*map) && viewers.of_markers) add(makeDeletionOfAll(map->frame_id));
  if (!viewers.of_points) points_.clear();
  if (viewers.of_markers) refresh();
  for (int i = 0; i < parameters_.chunks_per_update && budget.left() > 0.0; ++i) {
    noteCoarse();
    if (viewers.of_markers && viewers.took_all) {
      for (const Marker& deletion : noteLacking(map->frame_id)) add(deletion);
    }
    for (const MeshChunk& chunk : takeChunk(*map)) {
      if (viewers.of_points) keepPoints(chunk);
      if (viewers.of_markers) add(markerOf(map->frame_id, chunk, budget.left()));
    }
  }
  return markers;
}

void LiveSurface::noteLost(const MarkerTraffic::Lost& lost) {
  for (const int id : lost.ids) {
    if (static_cast<size_t>(id) < marked_.size()) lacking_.insert(id);
  }
  if (!lost.all_deleted) return;
  showAll();
  generation_ = 0;  // the next update begins with a DELETEALL
}

bool LiveSurface::beginAnew(SharedMap& map) {
  map.locked([this](FusedMap&) { chunks_->follow(); });
  if (generation_ == chunks_->generation()) return false;
  generation_ = chunks_->generation();
  marker_ids_.clear();
  marked_.clear();
  points_.clear();
  points_changed_ = true;
  coarse_.clear();
  lacking_.clear();
  left_of_round_ = 0;
  return true;
}

void LiveSurface::refresh() {
  const size_t room = static_cast<size_t>(parameters_.chunks_per_update);
  if (chunks_->changedCount() < room)
    chunks_->noteNext(std::min<size_t>(parameters_.refresh_chunks, room - chunks_->changedCount()));
}

void LiveSurface::noteCoarse() {
  if (chunks_->changedCount() == 0 && !coarse_.empty()) chunks_->noteAgain(*coarse_.begin());
}

std::vector<Marker> LiveSurface::noteLacking(const std::string& frame_id) {
  std::vector<Marker> deletions;
  while (chunks_->changedCount() == 0 && !lacking_.empty()) {
    const int id = *lacking_.begin();
    lacking_.erase(lacking_.begin());
    if (!chunks_->noteAgain(marked_.at(static_cast<size_t>(id))))
      deletions.push_back(makeDeletion(frame_id, id));
  }
  return deletions;
}

// One at a time, so that mapping never waits for more.
std::vector<MeshChunk> LiveSurface::takeChunk(SharedMap& map) {
  return map.locked([this](FusedMap& fused) {
    if (generation_ != fused.map().generation()) return std::vector<MeshChunk>();
    if (left_of_round_ == 0) {
      chunks_->sortChanged(fused.cameraPosition());
      left_of_round_ = chunks_->changedCount();
    }
    if (left_of_round_ > 0) --left_of_round_;
    return chunks_->takeChanged(1);
  });
}

Marker LiveSurface::markerOf(const std::string& frame_id, const MeshChunk& chunk, double left_bytes) {
  const auto [place, is_new] = marker_ids_.emplace(chunk.index, static_cast<int>(marked_.size()));
  if (is_new) marked_.push_back(chunk.index);
  const int id = place->second;
  coarse_.erase(chunk.index);
  lacking_.erase(id);
  if (chunk.mesh.triangles.empty()) return makeDeletion(frame_id, id);
  const double share = shareOf(chunk, left_bytes);
  if (share < wholeShare()) coarse_.insert(chunk.index);
  return makeSurfaceMarker(frame_id, id, simplified(chunk.mesh, share, OpenBorders::kStay));
}

double LiveSurface::shareOf(const MeshChunk& chunk, double left_bytes) const {
  const size_t others = std::min<size_t>(chunks_->changedCount(), parameters_.chunks_per_update);
  if (others == 0 || !canSimplify()) return wholeShare();
  const double fair_bytes = left_bytes / static_cast<double>(others + 1);
  const double fitting = fair_bytes / (kTriangleBytes * static_cast<double>(chunk.mesh.triangles.size()));
  return std::min(wholeShare(), std::max(fitting, kCoarsest));
}

double LiveSurface::wholeShare() const { return canSimplify() ? parameters_.triangle_share : 1.0; }

void LiveSurface::keepPoints(const MeshChunk& chunk) {
  points_changed_ = true;
  if (chunk.mesh.triangles.empty()) {
    points_.erase(chunk.index);
  } else {
    points_[chunk.index] = thinned(chunk.mesh, parameters_.point_spacing_m);
  }
}

boost::shared_ptr<SurfacePoints> LiveSurface::points(const std_msgs::Header& header,
                                                     const Eigen::Vector3d& sensor_W) const {
  std::vector<const TriangleMesh*> meshes;
  for (const auto& entry : points_) meshes.push_back(&entry.second);
  return makeSurfacePoints(header, sensor_W, meshes);
}

}  // namespace depth_fusion
