// The surface in chunks, so that a live view gets those that changed and no others.
#pragma once

#include <array>
#include <deque>
#include <memory>
#include <unordered_set>
#include <vector>

#include "depth_fusion/surface_mesh/surface_mesh.h"

namespace depth_fusion {

class SurfaceMeshKernels;

// A chunk's place: its first block is blocks_per_axis times it.
using MeshChunkIndex = std::array<int, 3>;

struct MeshChunk {
  MeshChunkIndex index;
  TriangleMesh mesh;  // empty: the surface that was there is gone
};

// Cubes of blocks whose surface is extracted one by one. The chunks' triangles together are those of
// exportSurfaceMesh, with the same vertices; chunks side by side repeat the vertices at their border and
// leave no crack. The device memory is allocated once, whatever the size of the map. Nothing here is
// synchronised: the caller sees to it that the map does not change during a call.
class MeshChunks {
 public:
  // Keeps references.
  MeshChunks(ComputeContext& compute, BlockSparseMap& map, const SurfaceMeshParameters& parameters = {},
             int blocks_per_axis = 16);
  ~MeshChunks();

  // The blocks in these slots have new contents or were released; to be told before the map gives the slots
  // away again.
  void noteUpdated(const std::vector<int>& slots);
  // Every chunk is to be extracted again, as for a reader that has none.
  void noteAll();
  // So are the next of the chunks with a surface, in turn, for readers that may lack some.
  void noteNext(size_t count);
  // The map was reset: forgets all chunks; none is reported as gone.
  void noteReset();

  // Chunks that takeChanged() has still to look at.
  size_t changedCount() const { return changed_.size(); }
  // Extracts up to max_count of the changed chunks, those that changed first before the others. A chunk that
  // has no surface and had none is not reported.
  std::vector<MeshChunk> takeChanged(size_t max_count);

  size_t deviceBytes() const;

 private:
  struct Hash {
    size_t operator()(const MeshChunkIndex& chunk) const;
  };
  using ChunkSet = std::unordered_set<MeshChunkIndex, Hash>;
  struct Extraction;

  // The chunks that look at the block: its own, and others to whose cells and normals it lends its voxels.
  void noteAround(const BlockSparseMap::BlockIndex& block);
  // The blocks of the chunks to be extracted.
  std::vector<Extraction> takeExtractions(size_t max_count);
  TriangleMesh extract(Extraction& extraction);

  BlockSparseMap& map_;
  int blocks_per_axis_;
  std::unique_ptr<SurfaceMeshKernels> kernels_;
  std::deque<MeshChunkIndex> changed_;  // in the order of their first change
  ChunkSet is_changed_;
  ChunkSet has_surface_;                 // as reported last
  std::vector<MeshChunkIndex> in_turn_;  // those that noteNext() has still to come to
};

}  // namespace depth_fusion
