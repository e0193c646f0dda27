#include "submaps/block_rows.h"

#include <algorithm>

#include "store/packed_row.h"
#include "submaps/row_parts.h"

namespace depth_fusion {
namespace {

constexpr int kGroupVoxels = 32;  // a group of blocks of a surface packs to some 10 kB

size_t planeBytes(const LayerPlane& plane, int block_size) {
  const auto m = static_cast<size_t>(block_size);
  return plane.bytes_per_voxel * m * m * m;
}

// Calls with the begin of each plane of each block in turn and its length: like lies beside like in a row,
// which compresses better.
template <class Function>
void forEachPlane(size_t blocks, const LayerRow& layer, int block_size, const Function& function) {
  size_t begin = 0;
  for (const LayerPlane& plane : layer.planes) {
    const size_t bytes = planeBytes(plane, block_size);
    for (size_t i = 0; i < blocks; ++i) function(i * layer.bytesPerBlock(block_size) + begin, bytes);
    begin += bytes;
  }
}

}  // namespace

int groupEdge(int block_size) { return std::max(1, kGroupVoxels / block_size); }

BlockIndex groupOf(const BlockIndex& block, int group_edge) {
  return block.unaryExpr([group_edge](int i) { return (i >= 0 ? i : i - group_edge + 1) / group_edge; });
}

BlockBox groupsAbout(const BlockBox& box, int group_edge) {
  const BlockIndex first = groupOf(box.min(), group_edge), last = groupOf(box.max(), group_edge);
  return {(first.array() - 1).matrix().eval(), (last.array() + 1).matrix().eval()};
}

BlockGroup clearedGroup(const std::vector<BlockIndex>& blocks, const LayerRow& layer, int block_size) {
  BlockGroup group{blocks, std::vector<int>(blocks.size(), 0), {}};
  for (size_t i = 0; i < blocks.size(); ++i) {
    for (const LayerPlane& plane : layer.planes) {
      const size_t voxels = planeBytes(plane, block_size) / plane.bytes_per_voxel;
      for (size_t voxel = 0; voxel < voxels; ++voxel)
        group.voxels.append(reinterpret_cast<const char*>(&plane.clear_value), plane.bytes_per_voxel);
    }
  }
  return group;
}

std::string blocksRow(const BlockGroup& group, const BlockIndex& index, const LayerRow& layer,
                      int block_size) {
  const int edge = groupEdge(block_size);
  ByteWriter bytes;
  bytes.number(static_cast<uint32_t>(group.blocks.size()));
  for (const BlockIndex& block : group.blocks) {
    const BlockIndex local = block - edge * index;
    bytes.number(static_cast<uint16_t>(local.x() + edge * (local.y() + edge * local.z())));
  }
  for (const int state : group.states) bytes.number(static_cast<uint16_t>(state));
  forEachPlane(group.blocks.size(), layer, block_size,
               [&](size_t begin, size_t count) { bytes.bytes(&group.voxels[begin], count); });
  return packed(bytes.take());
}

BlockGroup parseBlocks(const std::string& row, const BlockIndex& index, const LayerRow& layer, int block_size,
                       const std::string& where) {
  const int edge = groupEdge(block_size);
  const std::string contents = unpacked(row, where);
  ByteReader bytes(contents, where);
  BlockGroup group;
  const size_t count = readCount(bytes, 2 * sizeof(uint16_t) + layer.bytesPerBlock(block_size));
  int last = -1;
  for (size_t i = 0; i < count; ++i) {
    const int local = bytes.number<uint16_t>();
    check(local > last && local < edge * edge * edge, where + " has a block that does not belong there");
    last = local;
    group.blocks.emplace_back(edge * index +
                              BlockIndex(local % edge, local / edge % edge, local / edge / edge));
  }
  for (size_t i = 0; i < count; ++i) group.states.push_back(bytes.number<uint16_t>());
  group.voxels.resize(count * layer.bytesPerBlock(block_size));
  forEachPlane(count, layer, block_size, [&](size_t begin, size_t length) {
    const std::string_view voxels = bytes.bytes(length);
    std::copy(voxels.begin(), voxels.end(), &group.voxels[begin]);
  });
  checkAtEnd(bytes);
  return group;
}

}  // namespace depth_fusion
