// The surface of a whole map, however large it is.
#pragma once

#include <functional>

#include "depth_fusion/submaps/submap_collection.h"
#include "depth_fusion/surface_mesh/mesh_chunks.h"
#include "depth_fusion/surface_mesh/surface_mesh.h"

namespace depth_fusion {

class WholeMap;

// All the blocks of a map as they were when this was made, for exports beside mapping.
class WorldSnapshot {
 public:
  // Whoever calls it holds what guards the map. Throws Error if what the pool does not hold cannot be read.
  explicit WorldSnapshot(SubmapCollection& submaps);
  ~WorldSnapshot();

  bool hasColor() const { return parameters_.color; }

 private:
  friend MeshStatistics exportWorldMesh(ComputeContext&, WorldSnapshot&, MeshSink&,
                                        const SurfaceMeshParameters&, bool,
                                        const std::function<void(double)>&);
  MapParameters parameters_;
  std::unique_ptr<WholeMap> blocks_;
};

// Exports the surface in memory that does not depend on the map's size but for some 100 bytes a group of
// blocks and 40 a block. `progress` is called with the share that is done, and throws to give up. Throws
// Error as exportSurfaceMesh does, and if blocks cannot be read.
MeshStatistics exportWorldMesh(ComputeContext& compute, WorldSnapshot& world, MeshSink& sink,
                               const SurfaceMeshParameters& parameters, bool with_color,
                               const std::function<void(double)>& progress = nullptr);

// Parts of a map that are not in the pool, for whoever follows the map chunk by chunk.
class WorldParts final : public BlocksElsewhere {
 public:
  // Keeps references.
  WorldParts(ComputeContext& compute, SubmapCollection& submaps);
  ~WorldParts() override;

  // They are boxes of groups of blocks, each no larger than a chunk.
  std::vector<BlockBox> boxes() const override;
  // A map that has the blocks of the box, and those about it, until the next call; null if the pool has all
  // that there are. The boxes are cubes of the same size. Whoever calls it holds what guards the map. Throws
  // Error if blocks cannot be read.
  BlockMap* load(const BlockBox& box) override;

 private:
  class Loading;

  ComputeContext& compute_;
  SubmapCollection& submaps_;
  std::unique_ptr<Loading> loading_;  // made when it is needed
};

}  // namespace depth_fusion
