// The blocks of the map in batches that fit into the scratch memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "depth_fusion/map/block_map.h"
#include "shared/types.h"

namespace depth_fusion {

struct MeshBlock {
  uint64_t morton_code = 0;  // of the index, counted from the list's origin
  uint32_t vertices = 0;
  uint32_t triangles = 0;
  uint32_t first_vertex = 0;
  bool lends_only = false;  // its vertices, to other blocks' triangles; it emits none itself
};

// The origin is at or before all the blocks of a list, in each axis, and not 2^21 blocks away.
MeshBlock meshBlock(const BlockIndex& origin, const BlockIndex& index);
BlockIndex indexOf(const BlockIndex& origin, const MeshBlock& block);
// Along the Morton curve neighbours are mostly near each other.
void sortAlongMortonCurve(std::vector<MeshBlock>& blocks);

// Sets index and first vertex; the batch fills in the rest.
MeshBlockArgs blockArgs(const BlockIndex& origin, const MeshBlock& block);

struct BatchLimits {
  size_t blocks = 0;  // at least 8: a block and its neighbours
  size_t vertices = 0;
  size_t triangles = 0;
};

// A batch consists of core blocks, consecutive in Morton order, and after them of the halo: the other blocks
// to which the cores' cells reach.
struct MeshBatch {
  std::vector<MeshBlockArgs> blocks;
  size_t core_blocks = 0;
  uint32_t first_vertex = 0;
  uint32_t vertices = 0;
  uint32_t triangles = 0;
};

class MeshBatcher {
 public:
  // Keeps a reference. `blocks` is in Morton order, with counts and first vertices.
  MeshBatcher(const BlockIndex& origin, const std::vector<MeshBlock>& blocks, const BatchLimits& limits);

  // Whether the batches so far have all the blocks before `end`.
  bool done(size_t end) const { return next_ >= end; }
  // The next batch, of blocks before `end`.
  MeshBatch next(size_t end);

 private:
  // Finds the block and those beyond its far sides, as MeshBlockArgs numbers them; kNowhere stands for a
  // block that is not in the list or not needed.
  using Neighbours = std::array<size_t, 8>;
  static constexpr size_t kNowhere = static_cast<size_t>(-1);

  Neighbours neighboursOf(size_t block) const;
  bool fits(const MeshBatch& batch, size_t members, const MeshBlock& block) const;
  void fill(MeshBatch& batch, size_t core_begin, const std::vector<Neighbours>& core,
            const std::vector<size_t>& members);

  BlockIndex origin_;
  const std::vector<MeshBlock>& blocks_;
  BatchLimits limits_;
  std::vector<int> places_;  // in the current batch, -1 = not a member
  size_t next_ = 0;
};

}  // namespace depth_fusion
