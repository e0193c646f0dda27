#include "depth_fusion/surface_mesh/mesh_chunks.h"

#include <algorithm>
#include <unordered_map>

#include "depth_fusion/common/error.h"
#include "surface_mesh/mesh_extraction.h"
#include "surface_mesh/mesh_part.h"

namespace depth_fusion {
namespace {

int floorDivision(int a, int b) { return a >= 0 ? a / b : -((-a - 1) / b) - 1; }

MeshChunkIndex chunkOf(const BlockIndex& block, int blocks_per_axis) {
  return {floorDivision(block.x(), blocks_per_axis), floorDivision(block.y(), blocks_per_axis),
          floorDivision(block.z(), blocks_per_axis)};
}

// Calls visit(chunk, lends_only) for the block's chunk, and for those before it to whose far cells it lends
// vertices.
template <class Visit>
void forEachOwner(const BlockIndex& block, int blocks_per_axis, const Visit& visit) {
  const MeshChunkIndex own = chunkOf(block, blocks_per_axis);
  int on_near_side = 0;
  for (int axis = 0; axis < 3; ++axis) on_near_side |= (block[axis] == own[axis] * blocks_per_axis) << axis;
  for (int sides = 0; sides < 8; ++sides) {
    if ((sides & ~on_near_side) != 0) continue;
    visit(MeshChunkIndex{own[0] - (sides & 1), own[1] - (sides >> 1 & 1), own[2] - (sides >> 2)}, sides != 0);
  }
}

// Calls with each block of the map and each chunk that looks at it.
template <class Visit>
void forEachOwned(const BlockMap& map, int blocks_per_axis, const Visit& visit) {
  for (int slot = 0; slot < map.slots().bound(); ++slot) {
    if (!map.slots().inUse(slot)) continue;
    const BlockIndex& index = map.slots().blockOf(slot);
    forEachOwner(index, blocks_per_axis, [&](const MeshChunkIndex& chunk, bool lends_only) {
      MeshBlock block = meshBlock(map.window().origin, index);
      block.lends_only = lends_only;
      visit(chunk, block);
    });
  }
}

}  // namespace

struct MeshChunks::Extraction {
  MeshChunkIndex chunk;
  std::vector<MeshBlock> blocks;
};

size_t MeshChunks::Hash::operator()(const MeshChunkIndex& chunk) const {
  constexpr uint64_t kPrimes[3] = {73856093, 19349663, 83492791};
  uint64_t hash = 0;
  for (int axis = 0; axis < 3; ++axis)
    hash ^= static_cast<uint64_t>(static_cast<int64_t>(chunk[axis])) * kPrimes[axis];
  return static_cast<size_t>(hash);
}

MeshChunks::MeshChunks(ComputeContext& compute, BlockMap& map, const SurfaceMeshParameters& parameters,
                       int blocks_per_axis)
    : compute_(compute),
      map_(map),
      parameters_(parameters),
      changes_(map.follow()),
      blocks_per_axis_(blocks_per_axis) {
  validate(parameters_.table());
  check(blocks_per_axis > 0, "a chunk of the mesh needs at least one block per axis");
  kernels_ = std::make_unique<SurfaceMeshKernels>(compute, map, parameters_.min_certainty,
                                                  static_cast<size_t>(parameters_.max_batch_blocks));
}

MeshChunks::~MeshChunks() = default;

void MeshChunks::follow() {
  const MapChanges changes = changes_.take();
  if (changes.generation != generation_) forgetAll();
  generation_ = changes.generation;
  if (changes.complete) {
    noteShown();
    noteElsewhere();
  }
  for (const BlockIndex& block : changes.updated) noteAround(block);
  for (const BlockIndex& block : changes.released) noteAround(block);
  for (const BlockIndex& block : changes.evicted) noteAround(block);
}

void MeshChunks::noteElsewhere() {
  if (elsewhere_ == nullptr) return;
  for (const BlockBox& box : elsewhere_->boxes()) {
    noteAround(box.min());
    noteAround(box.max());
  }
}

void MeshChunks::noteAll() {
  noteShown();
  noteElsewhere();
  for (const SlotTable::Block& block : map_.slots().blocks()) noteAround(block.index);
}

void MeshChunks::noteNext(size_t count) {
  for (; count > 0; --count) {
    if (in_turn_.empty()) in_turn_.assign(has_surface_.begin(), has_surface_.end());
    if (in_turn_.empty()) return;
    note(in_turn_.back());
    in_turn_.pop_back();
  }
}

bool MeshChunks::noteAgain(const MeshChunkIndex& chunk) {
  const bool has_surface = has_surface_.count(chunk) > 0;
  if (has_surface) note(chunk);
  return has_surface;
}

void MeshChunks::sortChanged(const Eigen::Vector3d& point_W) {
  const MapParameters& map = map_.parameters();
  const double edge_m = static_cast<double>(map.voxel_size_m) * map.block_size * blocks_per_axis_;
  const auto distance = [&](const MeshChunkIndex& chunk) {
    const Eigen::Vector3d centre(chunk[0] + 0.5, chunk[1] + 0.5, chunk[2] + 0.5);
    return (edge_m * centre - point_W).squaredNorm();
  };
  std::stable_sort(changed_.begin(), changed_.end(), [&](const MeshChunkIndex& a, const MeshChunkIndex& b) {
    return distance(a) < distance(b);
  });
}

void MeshChunks::forgetAll() {
  changed_.clear();
  is_changed_.clear();
  has_surface_.clear();
  in_turn_.clear();
}

void MeshChunks::noteShown() {
  for (const MeshChunkIndex& chunk : has_surface_) note(chunk);
}

void MeshChunks::note(const MeshChunkIndex& chunk) {
  if (is_changed_.insert(chunk).second) changed_.push_back(chunk);
}

void MeshChunks::noteAround(const BlockIndex& block) {
  const MeshChunkIndex first = chunkOf(block - BlockIndex::Ones(), blocks_per_axis_);
  const MeshChunkIndex last = chunkOf(block + BlockIndex::Ones(), blocks_per_axis_);
  for (int z = first[2]; z <= last[2]; ++z) {
    for (int y = first[1]; y <= last[1]; ++y) {
      for (int x = first[0]; x <= last[0]; ++x) note({x, y, z});
    }
  }
}

std::vector<MeshChunk> MeshChunks::takeChanged(size_t max_count) {
  follow();
  std::vector<MeshChunk> chunks;
  for (Extraction& extraction : takeExtractions(max_count)) {
    BlockMap* elsewhere = elsewhere_ ? elsewhere_->load(boxOf(extraction.chunk)) : nullptr;
    TriangleMesh mesh =
        elsewhere ? extractFrom(*elsewhere, extraction.chunk) : extract(*kernels_, map_, extraction);
    const bool had_surface = has_surface_.erase(extraction.chunk) > 0;
    if (!mesh.triangles.empty()) has_surface_.insert(extraction.chunk);
    if (had_surface || !mesh.triangles.empty()) chunks.push_back({extraction.chunk, std::move(mesh)});
  }
  return chunks;
}

std::vector<MeshChunks::Extraction> MeshChunks::takeExtractions(size_t max_count) {
  std::vector<Extraction> extractions;
  std::unordered_map<MeshChunkIndex, size_t, Hash> place;
  while (!changed_.empty() && extractions.size() < max_count) {
    place[changed_.front()] = extractions.size();
    is_changed_.erase(changed_.front());
    extractions.push_back({changed_.front(), {}});
    changed_.pop_front();
  }
  forEachOwned(map_, blocks_per_axis_, [&](const MeshChunkIndex& chunk, const MeshBlock& block) {
    const auto found = place.find(chunk);
    if (found != place.end()) extractions[found->second].blocks.push_back(block);
  });
  return extractions;
}

TriangleMesh MeshChunks::extractFrom(BlockMap& map, const MeshChunkIndex& chunk) {
  if (kernels_elsewhere_ == nullptr)
    kernels_elsewhere_ = std::make_unique<SurfaceMeshKernels>(
        compute_, map, parameters_.min_certainty, static_cast<size_t>(parameters_.max_batch_blocks));
  Extraction extraction{chunk, {}};
  forEachOwned(map, blocks_per_axis_, [&](const MeshChunkIndex& owner, const MeshBlock& block) {
    if (owner == chunk) extraction.blocks.push_back(block);
  });
  return extract(*kernels_elsewhere_, map, extraction);
}

BlockBox MeshChunks::boxOf(const MeshChunkIndex& chunk) const {
  return cubeFrom(blocks_per_axis_ * BlockIndex(chunk[0], chunk[1], chunk[2]), blocks_per_axis_);
}

TriangleMesh MeshChunks::extract(SurfaceMeshKernels& kernels, const BlockMap& map,
                                 Extraction& extraction) const {
  sortAlongMortonCurve(extraction.blocks);
  const BlockIndex& origin = map.window().origin;
  countBlocks(kernels, origin, extraction.blocks);
  TriangleMesh mesh;
  MeshSize size = numberVertices(extraction.blocks);
  size.colored = map.hasLayer(kColorLayer);
  mesh.begin(size);
  MeshEmission(kernels, origin, extraction.blocks, size.colored, mesh).emitUpTo(extraction.blocks.size());
  mesh.finish();
  return partOf(mesh, mesh.triangles);
}

size_t MeshChunks::deviceBytes() const { return kernels_->deviceBytes(); }

}  // namespace depth_fusion
