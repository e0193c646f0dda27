// The surface in chunks, so that a live view gets those that changed and no others.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <unordered_set>
#include <vector>

#include "depth_fusion/map/blocks_elsewhere.h"
#include "depth_fusion/surface_mesh/surface_mesh.h"

namespace depth_fusion {

class SurfaceMeshKernels;

// A chunk's place: its first block is blocks_per_axis times it.
using MeshChunkIndex = std::array<int, 3>;

struct MeshChunk {
  MeshChunkIndex index;
  TriangleMesh mesh;  // empty: the surface that was there is gone
};

// Cubes of blocks whose surface is extracted one by one, as the map that they follow changes. The chunks'
// triangles together are those of exportSurfaceMesh, with the same vertices; chunks side by side repeat the
// vertices at their border and leave no crack. The device memory is allocated once, whatever the size of the
// map. Nothing here is synchronised: the caller sees to it that the map does not change during a call.
class MeshChunks {
 public:
  // Keeps references.
  MeshChunks(ComputeContext& compute, BlockMap& map, const SurfaceMeshParameters& parameters = {},
             int blocks_per_axis = 16);
  ~MeshChunks();

  // Chunks of which a part is elsewhere are extracted from there.
  void lookElsewhere(std::unique_ptr<BlocksElsewhere> elsewhere) { elsewhere_ = std::move(elsewhere); }

  // Takes note of what changed in the map since the last call. After a reset of the map all chunks are
  // forgotten; none is reported as gone.
  void follow();
  // The generation of the map that the chunks are of; 0 before the first follow().
  uint32_t generation() const { return generation_; }

  // Every chunk is to be extracted again, as for a reader that has none.
  void noteAll();
  // `count` of the chunks with a surface, the next ones in turn, are to be extracted again, for readers that
  // may lack some.
  void noteNext(size_t count);

  // The chunk is to be extracted again, if it has a surface; returns whether it has.
  bool noteAgain(const MeshChunkIndex& chunk);

  // Chunks that takeChanged() has still to look at, as far as follow() knows.
  size_t changedCount() const { return changed_.size(); }
  // Of these, the nearest to the point are to come first; those that change from now on come after them.
  void sortChanged(const Eigen::Vector3d& point_W);
  // Follows the map, and extracts up to max_count of the changed chunks, those that changed first before the
  // others, as far as they were not sorted. A chunk that has no surface and had none is not reported.
  std::vector<MeshChunk> takeChanged(size_t max_count);

  size_t deviceBytes() const;

 private:
  struct Hash {
    size_t operator()(const MeshChunkIndex& chunk) const;
  };
  using ChunkSet = std::unordered_set<MeshChunkIndex, Hash>;
  struct Extraction;

  void note(const MeshChunkIndex& chunk);
  // Notes the chunks that look at the block: its own, and others to whose cells and normals it lends its
  // voxels.
  void noteAround(const BlockIndex& block);
  void noteShown();
  void noteElsewhere();
  void forgetAll();
  // The next chunks to be extracted, with their blocks.
  std::vector<Extraction> takeExtractions(size_t max_count);
  // The surface of the chunk's blocks, which are in the map that the kernels read.
  TriangleMesh extract(SurfaceMeshKernels& kernels, const BlockMap& map, Extraction& extraction) const;
  TriangleMesh extractFrom(BlockMap& map, const MeshChunkIndex& chunk);
  BlockBox boxOf(const MeshChunkIndex& chunk) const;

  ComputeContext& compute_;
  BlockMap& map_;
  SurfaceMeshParameters parameters_;
  std::unique_ptr<BlocksElsewhere> elsewhere_;  // null: nothing is elsewhere
  MapSubscription changes_;
  uint32_t generation_ = 0;
  int blocks_per_axis_;
  std::unique_ptr<SurfaceMeshKernels> kernels_, kernels_elsewhere_;  // the latter when they are needed
  std::deque<MeshChunkIndex> changed_;                               // in the order of their first change
  ChunkSet is_changed_;
  ChunkSet has_surface_;                 // as reported last
  std::vector<MeshChunkIndex> in_turn_;  // chunks that noteNext() has still to come to
};

}  // namespace depth_fusion
