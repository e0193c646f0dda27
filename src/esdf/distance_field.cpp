#include "esdf/distance_field.h"

#include <algorithm>

#include "map/map_args.h"

namespace depth_fusion {
namespace {

constexpr int kLongestBox = 10;  // blocks to an axis, computed together

BlockBox boxAbout(const std::vector<BlockIndex>& blocks) {
  BlockBox box;
  for (const BlockIndex& block : blocks) box.extend(block);
  return box;
}

}  // namespace

void DistanceField::compute(const std::vector<BlockIndex>& blocks, const Take& take) {
  if (blocks.empty()) return;
  const BlockBox box = boxAbout(blocks);
  int longest = 0;
  const int length = box.sizes().maxCoeff(&longest) + 1;
  if (length <= kLongestBox) return computeTogether(blocks, box, take);
  const int middle = box.min()[longest] + length / 2;
  std::vector<BlockIndex> before, beyond;
  for (const BlockIndex& block : blocks) (block[longest] < middle ? before : beyond).push_back(block);
  compute(before, take);
  compute(beyond, take);
}

void DistanceField::computeTogether(const std::vector<BlockIndex>& blocks, const BlockBox& box,
                                    const Take& take) {
  const int margin = (kernels_.args().reach + ESDF_BLOCK - 1) / ESDF_BLOCK;
  const BlockBox around((box.min().array() - margin).matrix(), (box.max().array() + margin).matrix());
  EsdfRegionArgs region{};
  for (int axis = 0; axis < 3; ++axis) {
    region.blocks[axis] = around.sizes()[axis] + 1;
    region.first[axis] = ESDF_BLOCK * margin;
    region.size[axis] = ESDF_BLOCK * (box.sizes()[axis] + 1);
  }
  uploadSlots(around);
  const size_t width = static_cast<size_t>(ESDF_BLOCK) * static_cast<size_t>(region.blocks[0]);
  const size_t depth = static_cast<size_t>(ESDF_BLOCK) * static_cast<size_t>(region.blocks[1]);
  const size_t rows = static_cast<size_t>(region.size[1]), levels = static_cast<size_t>(region.size[2]);
  ensureBytes(compute_, along_z_, width * depth * levels, "distances along z");
  ensureBytes(compute_, planes_, width * rows * levels * sizeof(uint32_t), "distances in planes");
  std::vector<BlockRequest> list;
  for (const BlockIndex& block : blocks) {
    const Eigen::Vector3i first = ESDF_BLOCK * (block - around.min());
    list.push_back({first.x(), first.y(), first.z(), cells_.find(block)});
  }
  ensureBytes(compute_, blocks_, list.size() * sizeof(BlockRequest), "blocks of cells");
  ensureBytes(compute_, results_, list.size() * ESDF_CELLS * sizeof(int32_t), "distances");
  blocks_.write(list);
  kernels_.nearestAlongZ(slots_, cells_, along_z_, region);
  kernels_.nearestAlongY(along_z_, planes_, region);
  kernels_.nearestAlongX(slots_, cells_, planes_, blocks_, static_cast<int>(list.size()), results_, region);
  const std::vector<int32_t> results = results_.read<int32_t>(list.size() * ESDF_CELLS);
  for (size_t i = 0; i < blocks.size(); ++i) take(blocks[i], results.data() + i * ESDF_CELLS);
}

void DistanceField::uploadSlots(const BlockBox& region) {
  std::vector<int> slots;
  forEachIn(region, [&](const BlockIndex& block) { slots.push_back(cells_.find(block)); });
  ensureBytes(compute_, slots_, slots.size() * sizeof(int), "slots of a region");
  slots_.write(slots);
}

}  // namespace depth_fusion
