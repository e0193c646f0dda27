#include "submaps/part_loader.h"

namespace depth_fusion {

BlockBox groupsAbout(const BlockBox& box, int group_edge) {
  const BlockIndex first = groupOf(box.min(), group_edge), last = groupOf(box.max(), group_edge);
  return {(first.array() - 1).matrix().eval(), (last.array() + 1).matrix().eval()};
}

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
  for (int z = about.min().z(); z <= about.max().z(); ++z) {
    for (int y = about.min().y(); y <= about.max().y(); ++y) {
      for (int x = about.min().x(); x <= about.max().x(); ++x) {
        if (world.groups().count({x, y, z}) == 0) continue;
        groups.push_back(world.groupOfWorld({x, y, z}));
        const std::vector<BlockIndex>& of_group = groups.back().front().blocks;
        blocks.insert(blocks.end(), of_group.begin(), of_group.end());
      }
    }
  }
  const std::vector<int> slots = map_->insert(blocks);
  for (size_t layer = 0; layer < layers_.size(); ++layer) {
    std::string voxels;
    for (const BlockGroups& group : groups) voxels += group[layer].voxels;
    map_->setVoxels(layers_[layer].name, slots, voxels);
  }
}

}  // namespace depth_fusion
