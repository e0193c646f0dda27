#include "submaps/part_loader.h"

namespace depth_fusion {

PartLoader::PartLoader(ComputeContext& compute, const MapParameters& parameters, int edge_blocks,
                       size_t most_blocks)
    : edge_(groupEdge(parameters.block_size)), layers_(layersOf(parameters)) {
  MapParameters part = parameters;
  part.blocks_per_axis = edge_blocks + 2 * edge_;
  part.pool_mib =
      static_cast<int>(most_blocks * layers_.front().bytesPerBlock(parameters.block_size) >> 20) + 1;
  map_ = std::make_unique<BlockMap>(compute, part);
}

void PartLoader::load(WholeMap& world, const BlockBox& box) {
  const BlockBox about = groupsAbout(box, edge_);
  map_->resetAt(edge_ * about.min());
  std::vector<BlockGroups> groups;
  std::vector<BlockIndex> blocks;
  forEachIn(about, [&](const BlockIndex& group) {
    if (world.groups().count(group) == 0) return;
    groups.push_back(world.groupOfWorld(group));
    const std::vector<BlockIndex>& of_group = groups.back().front().blocks;
    blocks.insert(blocks.end(), of_group.begin(), of_group.end());
  });
  const std::vector<int> slots = map_->insert(blocks);
  for (size_t layer = 0; layer < layers_.size(); ++layer) {
    std::string voxels;
    for (const BlockGroups& group : groups) voxels += group[layer].voxels;
    map_->setVoxels(layers_[layer].name, slots, voxels);
  }
}

}  // namespace depth_fusion
