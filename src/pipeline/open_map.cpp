#include "pipeline/open_map.h"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <utility>
#include <vector>

#include "depth_fusion/compute/device_image.h"
#include "depth_fusion/pipeline/stored_map.h"
#include "depth_fusion/submaps/world_mesh.h"

namespace depth_fusion {
namespace {

PipelineParameters adopted(PipelineParameters parameters, Database& database) {
  const MapDescription description = describeMap(database);
  adoptParameters(description, parameters);
  const auto& layers = description.layers;
  parameters.map.color = std::find(layers.begin(), layers.end(), "color") != layers.end();
  return parameters;
}

}  // namespace

OpenMap::OpenMap(ComputeContext& compute, const PipelineParameters& parameters, Database& database)
    : compute_(compute),
      name_(database.name()),
      parameters_(adopted(parameters, database)),
      map_(compute, parameters_.map),
      submaps_(map_, parameters_.submaps) {
  ReadMap read(database, submaps_);
  loaded_ = read.loaded();
  read.moveTo(submaps_);
  mapper_ = std::make_unique<Mapper>(compute, map_, submaps_, parameters_, loaded_.description.camera);
}

MeshStatistics OpenMap::exportMesh(MeshSink& sink) {
  WorldSnapshot world(submaps_);
  return exportWorldMesh(compute_, world, sink, parameters_.surface_mesh, world.hasColor());
}

const ModelView& OpenMap::render(const Pose& T_W_D) {
  StageTimers timers;
  return mapper_->render(T_W_D, timers);
}

Keyframe OpenMap::seen(const Keyframe& keyframe) {
  Keyframe seen = keyframe;
  const ModelView& view = render(keyframe.T_W_D);
  seen.view = KeyframeView(readImage(view.depth, view.camera), view.camera, parameters_.loops.view_width_px);
  if (!parameters_.map.color) return seen;
  std::vector<uchar> jpeg;
  cv::imencode(".jpg", mapper_->renderer().coloredPicture(), jpeg);
  seen.color = {{jpeg.begin(), jpeg.end()}, view.camera, Pose::Identity()};
  return seen;
}

}  // namespace depth_fusion
