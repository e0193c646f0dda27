#include "depth_fusion/submaps/world_mesh.h"

#include <algorithm>
#include <utility>

#include "submaps/part_loader.h"

namespace depth_fusion {
namespace {

constexpr int kPartVoxels = 256;

// A whole map, part by part.
class WorldSource final : public MeshSource {
 public:
  WorldSource(ComputeContext& compute, WholeMap& world, const MapParameters& parameters,
              const std::function<void(double)>& progress)
      : world_(world),
        edge_(groupEdge(parameters.block_size)),
        part_blocks_(kPartVoxels / parameters.block_size),
        progress_(progress),
        first_group_(firstGroup()),
        loader_(compute, parameters, part_blocks_, largestPart()) {}

  std::vector<BlockBox> parts() override {
    std::set<BlockIndex, BlockOrder> places;
    for (const auto& [group, counts] : world_.groups()) places.insert(placeOf(group));
    std::vector<BlockBox> parts;
    for (const BlockIndex& place : places)
      parts.push_back(cubeFrom(origin() + part_blocks_ * place, part_blocks_));
    return parts;
  }
  BlockIndex origin() const override { return edge_ * first_group_; }
  BlockMap& map() override { return loader_.map(); }

  void load(const BlockBox& part, double done) override {
    if (progress_) progress_(done);
    loader_.load(world_, part);
  }

 private:
  BlockIndex firstGroup() const {
    if (world_.groups().empty()) return BlockIndex::Zero();
    BlockIndex first = world_.groups().begin()->first;
    for (const auto& [group, counts] : world_.groups()) first = first.cwiseMin(group);
    return first;
  }

  // The number in each axis of the part that has the group.
  BlockIndex placeOf(const BlockIndex& group) const {
    return groupOf(group - first_group_, part_blocks_ / edge_);
  }

  // In blocks, with those about it.
  size_t largestPart() const {
    std::map<BlockIndex, size_t, BlockOrder> parts;
    for (const auto& [group, counts] : world_.groups()) {
      size_t blocks = 0;
      for (const auto& [submap, count] : counts) blocks += count;
      std::set<BlockIndex, BlockOrder> near;
      for (int n = 0; n < 27; ++n)
        near.insert(placeOf(group + BlockIndex(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
      for (const BlockIndex& part : near) parts[part] += blocks;
    }
    size_t most = 1;
    for (const auto& [part, blocks] : parts) most = std::max(most, blocks);
    return most;
  }

  WholeMap& world_;
  const int edge_, part_blocks_;
  const std::function<void(double)>& progress_;
  const BlockIndex first_group_;
  PartLoader loader_;
};

}  // namespace

WorldSnapshot::WorldSnapshot(SubmapCollection& submaps)
    : parameters_(submaps.map().parameters()), blocks_(std::make_unique<WholeMap>(submaps)) {}

WorldSnapshot::~WorldSnapshot() = default;

MeshStatistics exportWorldMesh(ComputeContext& compute, WorldSnapshot& world, MeshSink& sink,
                               const SurfaceMeshParameters& parameters, bool with_color,
                               const std::function<void(double)>& progress) {
  MapParameters map = world.parameters_;
  map.color = map.color && with_color;
  WorldSource source(compute, *world.blocks_, map, progress);
  return exportSurfaceMesh(compute, source, sink, parameters);
}

// What of a map is not in the pool, in cubes.
class WorldParts::Loading {
 public:
  Loading(ComputeContext& compute, SubmapCollection& submaps, int edge_blocks)
      : submaps_(submaps),
        edge_(groupEdge(submaps.map().parameters().block_size)),
        loader_(compute, submaps.map().parameters(), edge_blocks, mostBlocks(edge_blocks)) {}

  BlockMap& load(const BlockBox& box) {
    std::set<BlockIndex, BlockOrder> groups;
    forEachIn(groupsAbout(box, edge_), [&](const BlockIndex& group) { groups.insert(group); });
    WholeMap part(submaps_, &groups);
    loader_.load(part, box);
    return loader_.map();
  }

 private:
  size_t mostBlocks(int edge_blocks) const {
    const size_t edge = static_cast<size_t>(edge_blocks) + 2 * static_cast<size_t>(edge_);
    return edge * edge * edge;
  }

  SubmapCollection& submaps_;
  int edge_;
  PartLoader loader_;
};

WorldParts::WorldParts(ComputeContext& compute, SubmapCollection& submaps)
    : compute_(compute), submaps_(submaps) {}

WorldParts::~WorldParts() = default;

std::vector<BlockBox> WorldParts::boxes() const {
  const int edge = groupEdge(submaps_.map().parameters().block_size);
  std::vector<BlockBox> boxes;
  for (const BlockIndex& group : submaps_.storedGroups()) boxes.push_back(cubeFrom(edge * group, edge));
  return boxes;
}

BlockMap* WorldParts::load(const BlockBox& box) {
  if (submaps_.isInPool(box)) return nullptr;
  const int edge_blocks = box.sizes().maxCoeff() + 1;
  if (loading_ == nullptr) loading_ = std::make_unique<Loading>(compute_, submaps_, edge_blocks);
  return &loading_->load(box);
}

}  // namespace depth_fusion
