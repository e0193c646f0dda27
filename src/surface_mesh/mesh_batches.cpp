#include "surface_mesh/mesh_batches.h"

#include <algorithm>

namespace depth_fusion {
namespace {

constexpr uint64_t kAxisBits[3] = {0x1249249249249249, 0x2492492492492492, 0x4924924924924924};

// Spreads the number's bits so that they stand three apart.
uint64_t spread(uint64_t number) {
  uint64_t bits = 0;
  for (int bit = 0; bit < 21; ++bit) bits |= (number >> bit & 1) << (3 * bit);
  return bits;
}

int gathered(uint64_t bits) {
  int number = 0;
  for (int bit = 0; bit < 21; ++bit) number |= static_cast<int>(bits >> (3 * bit) & 1) << bit;
  return number;
}

uint64_t mortonCode(const Eigen::Vector3i& index) {
  return spread(index.x()) | spread(index.y()) << 1 | spread(index.z()) << 2;
}

Eigen::Vector3i placeOf(uint64_t code) { return {gathered(code), gathered(code >> 1), gathered(code >> 2)}; }

uint64_t nextAlong(uint64_t code, int axis) {
  const uint64_t mask = kAxisBits[axis];
  return (((code | ~mask) + (uint64_t{1} << axis)) & mask) | (code & ~mask);
}

}  // namespace

MeshBlock meshBlock(const BlockIndex& origin, const BlockIndex& index) {
  MeshBlock block;
  block.morton_code = mortonCode(index - origin);
  return block;
}

BlockIndex indexOf(const BlockIndex& origin, const MeshBlock& block) {
  return origin + placeOf(block.morton_code);
}

void sortAlongMortonCurve(std::vector<MeshBlock>& blocks) {
  std::sort(blocks.begin(), blocks.end(),
            [](const MeshBlock& a, const MeshBlock& b) { return a.morton_code < b.morton_code; });
}

MeshBlockArgs blockArgs(const BlockIndex& origin, const MeshBlock& block) {
  MeshBlockArgs args{};
  const BlockIndex index = indexOf(origin, block);
  for (int axis = 0; axis < 3; ++axis) args.index[axis] = index[axis];
  args.first_vertex = block.first_vertex;
  return args;
}

MeshBatcher::MeshBatcher(const BlockIndex& origin, const std::vector<MeshBlock>& blocks,
                         const BatchLimits& limits)
    : origin_(origin), blocks_(blocks), limits_(limits), places_(blocks.size(), -1) {}

MeshBatch MeshBatcher::next(size_t end) {
  const size_t begin = next_;
  MeshBatch batch;
  batch.first_vertex = blocks_[begin].first_vertex;
  std::vector<Neighbours> core;
  std::vector<size_t> members;
  for (; !done(end) && (next_ == begin || fits(batch, members.size(), blocks_[next_])); ++next_) {
    core.push_back(neighboursOf(next_));
    for (const size_t neighbour : core.back()) {
      if (neighbour == kNowhere || places_[neighbour] >= 0) continue;
      places_[neighbour] = 0;
      members.push_back(neighbour);
    }
    batch.vertices += blocks_[next_].vertices;
    batch.triangles += blocks_[next_].triangles;
  }
  fill(batch, begin, core, members);
  return batch;
}

MeshBatcher::Neighbours MeshBatcher::neighboursOf(size_t block) const {
  Neighbours neighbours;
  neighbours.fill(kNowhere);
  neighbours[0] = block;
  for (int n = 1; n < 8 && !blocks_[block].lends_only; ++n) {
    uint64_t code = blocks_[block].morton_code;
    for (int axis = 0; axis < 3; ++axis) {
      if ((n >> axis & 1) != 0) code = nextAlong(code, axis);
    }
    const auto found =
        std::lower_bound(blocks_.begin() + static_cast<std::ptrdiff_t>(block), blocks_.end(), code,
                         [](const MeshBlock& b, uint64_t c) { return b.morton_code < c; });
    if (found != blocks_.end() && found->morton_code == code)
      neighbours[n] = static_cast<size_t>(found - blocks_.begin());
  }
  return neighbours;
}

bool MeshBatcher::fits(const MeshBatch& batch, size_t members, const MeshBlock& block) const {
  return members + Neighbours().size() <= limits_.blocks &&
         batch.vertices + block.vertices <= limits_.vertices &&
         batch.triangles + block.triangles <= limits_.triangles;
}

void MeshBatcher::fill(MeshBatch& batch, size_t core_begin, const std::vector<Neighbours>& core,
                       const std::vector<size_t>& members) {
  batch.core_blocks = core.size();
  uint32_t first_triangle = 0;
  for (size_t block = core_begin; block < next_; ++block) {
    places_[block] = static_cast<int>(batch.blocks.size());
    batch.blocks.push_back(blockArgs(origin_, blocks_[block]));
    batch.blocks.back().first_triangle = first_triangle;
    first_triangle += blocks_[block].triangles;
  }
  for (const size_t member : members) {
    if (member < next_) continue;
    places_[member] = static_cast<int>(batch.blocks.size());
    batch.blocks.push_back(blockArgs(origin_, blocks_[member]));
  }
  for (size_t i = 0; i < core.size(); ++i) {
    for (int n = 0; n < 8; ++n)
      batch.blocks[i].neighbours[n] = core[i][n] == kNowhere ? -1 : places_[core[i][n]];
    if (blocks_[core_begin + i].lends_only) batch.blocks[i].neighbours[0] = -1;
  }
  for (const size_t member : members) places_[member] = -1;
}

}  // namespace depth_fusion
