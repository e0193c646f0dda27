#include "submaps/pool_groups.h"

#include <algorithm>
#include <utility>

namespace depth_fusion {
namespace {

size_t bytesPerBlock(const BlockGroup& group) { return group.voxels.size() / group.blocks.size(); }

void append(BlockGroup& group, const BlockGroup& source, size_t place, size_t bytes) {
  group.blocks.push_back(source.blocks[place]);
  group.states.push_back(source.states[place]);
  group.voxels.append(source.voxels, place * bytes, bytes);
}

BlockGroup joined(const BlockGroup& a, const BlockGroup& b) {
  const size_t bytes = a.blocks.empty() ? bytesPerBlock(b) : bytesPerBlock(a);
  BlockGroup all;
  for (size_t i = 0, j = 0; i < a.blocks.size() || j < b.blocks.size();) {
    const bool takes_a = j == b.blocks.size() || (i < a.blocks.size() && !before(b.blocks[j], a.blocks[i]));
    if (takes_a && j < b.blocks.size() && a.blocks[i] == b.blocks[j]) ++j;
    takes_a ? append(all, a, i++, bytes) : append(all, b, j++, bytes);
  }
  return all;
}

}  // namespace

std::map<BlockIndex, BlockGroups, BlockOrder> groupsIn(BlockMap& map, const std::vector<LayerRow>& layers,
                                                       std::vector<int> slots) {
  std::sort(slots.begin(), slots.end());
  const int block_size = map.parameters().block_size;
  BlockGroup all;
  for (const int slot : slots) all.blocks.push_back(map.slots().blockOf(slot));
  all.states = map.states(slots);
  std::map<BlockIndex, std::vector<size_t>, BlockOrder> places;
  for (size_t place = 0; place < slots.size(); ++place)
    places[groupOf(all.blocks[place], groupEdge(block_size))].push_back(place);
  std::map<BlockIndex, BlockGroups, BlockOrder> groups;
  for (auto& [index, of_group] : places) {
    std::sort(of_group.begin(), of_group.end(),
              [&](size_t a, size_t b) { return before(all.blocks[a], all.blocks[b]); });
    groups[index].resize(layers.size());
  }
  for (size_t layer = 0; layer < layers.size(); ++layer) {
    all.voxels = map.voxels(layers[layer].name, slots);
    for (const auto& [index, of_group] : places) {
      for (const size_t place : of_group)
        append(groups[index][layer], all, place, layers[layer].bytesPerBlock(block_size));
    }
  }
  return groups;
}

BlockGroups joined(const BlockGroups& a, const BlockGroups& b) {
  BlockGroups all;
  for (size_t layer = 0; layer < a.size(); ++layer) all.push_back(joined(a[layer], b[layer]));
  return all;
}

BlockGroups partOf(const BlockGroups& group, const Window& window, bool inside) {
  BlockGroups part(group.size());
  for (size_t layer = 0; layer < group.size(); ++layer) {
    for (size_t place = 0; place < group[layer].blocks.size(); ++place) {
      if (window.contains(group[layer].blocks[place]) == inside)
        append(part[layer], group[layer], place, bytesPerBlock(group[layer]));
    }
  }
  return part;
}

}  // namespace depth_fusion
