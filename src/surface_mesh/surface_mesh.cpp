#include "depth_fusion/surface_mesh/surface_mesh.h"

#include <algorithm>

#include "surface_mesh/mesh_extraction.h"

namespace depth_fusion {
namespace {

// A map that is in memory, as its own only part.
class MapSource final : public MeshSource {
 public:
  explicit MapSource(BlockMap& map) : map_(map) {}

  std::vector<BlockBox> parts() override {
    return {cubeFrom(map_.window().origin, map_.window().blocks_per_axis)};
  }
  BlockIndex origin() const override { return map_.window().origin; }
  BlockMap& map() override { return map_; }
  void load(const BlockBox&, double) override {}

 private:
  BlockMap& map_;
};

// The blocks of the map in the box, in Morton order.
std::vector<MeshBlock> blocksIn(const BlockMap& map, const BlockBox& box, const BlockIndex& origin) {
  std::vector<MeshBlock> blocks;
  for (int slot = 0; slot < map.slots().bound(); ++slot) {
    if (map.slots().inUse(slot) && box.contains(map.slots().blockOf(slot)))
      blocks.push_back(meshBlock(origin, map.slots().blockOf(slot)));
  }
  sortAlongMortonCurve(blocks);
  return blocks;
}

// The parts in Morton order.
std::vector<BlockBox> sortedParts(MeshSource& source) {
  std::vector<BlockBox> parts = source.parts();
  const BlockIndex origin = source.origin();
  std::sort(parts.begin(), parts.end(), [&](const BlockBox& a, const BlockBox& b) {
    return meshBlock(origin, a.min()).morton_code < meshBlock(origin, b.min()).morton_code;
  });
  return parts;
}

}  // namespace

MeshStatistics exportSurfaceMesh(ComputeContext& compute, BlockMap& map, MeshSink& sink,
                                 SurfaceMeshParameters parameters) {
  MapSource source(map);
  return exportSurfaceMesh(compute, source, sink, parameters);
}

MeshStatistics exportSurfaceMesh(ComputeContext& compute, MeshSource& source, MeshSink& sink,
                                 SurfaceMeshParameters parameters) {
  validate(parameters.table());
  BlockMap& map = source.map();
  SurfaceMeshKernels kernels(compute, map, parameters.min_certainty,
                             static_cast<size_t>(parameters.max_batch_blocks));
  const BlockIndex origin = source.origin();
  const std::vector<BlockBox> parts = sortedParts(source);
  const auto count = static_cast<double>(parts.size());
  MeshStatistics statistics;
  statistics.device_bytes = kernels.deviceBytes();
  std::vector<MeshBlock> blocks;  // with a surface
  std::vector<size_t> ends;       // of the parts in them
  for (size_t i = 0; i < parts.size(); ++i) {
    source.load(parts[i], 0.5 * static_cast<double>(i) / count);
    std::vector<MeshBlock> part = blocksIn(map, parts[i], origin);
    statistics.blocks += part.size();
    countBlocks(kernels, origin, part);
    blocks.insert(blocks.end(), part.begin(), part.end());
    ends.push_back(blocks.size());
  }
  statistics.size = numberVertices(blocks);
  statistics.size.colored = map.hasLayer(kColorLayer);
  sink.begin(statistics.size);
  MeshEmission emission(kernels, origin, blocks, statistics.size.colored, sink);
  for (size_t i = 0; i < parts.size(); ++i) {
    source.load(parts[i], 0.5 + 0.5 * static_cast<double>(i) / count);
    emission.emitUpTo(ends[i]);
  }
  sink.finish();
  statistics.batches = emission.batches();
  return statistics;
}

}  // namespace depth_fusion
