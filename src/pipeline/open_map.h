// A stored map that is open to be looked at, and what its keyframes see of it.
#pragma once

#include <memory>
#include <string>

#include "depth_fusion/pipeline/mapper.h"
#include "depth_fusion/submaps/map_file.h"
#include "depth_fusion/surface_mesh/surface_mesh.h"

namespace depth_fusion {

class OpenMap {
 public:
  // Keeps a reference. The parameters are those of the map where it has its own. Throws Error if it is
  // damaged.
  OpenMap(ComputeContext& compute, const PipelineParameters& parameters, Database& database);

  const std::string& name() const { return name_; }
  const PipelineParameters& parameters() const { return parameters_; }
  const LoadedMap& loaded() const { return loaded_; }

  // The surface, with colours if the map has them. Throws Error if the sink does.
  MeshStatistics exportMesh(MeshSink& sink);

  // The map as its sensor sees it from there; valid until the next call.
  const ModelView& render(const Pose& T_W_D);
  // The keyframe with its view of the map as it is now, and with colour if the map has it.
  Keyframe seen(const Keyframe& keyframe);

 private:
  ComputeContext& compute_;
  const std::string name_;
  PipelineParameters parameters_;
  BlockMap map_;
  SubmapCollection submaps_;
  LoadedMap loaded_;
  std::unique_ptr<Mapper> mapper_;
};

}  // namespace depth_fusion
