#include "apps/view/stored_model.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <set>

#include "depth_fusion/pipeline/pipeline_parameters.h"
#include "depth_fusion/pipeline/stored_map.h"
#include "depth_fusion/submaps/map_file.h"
#include "depth_fusion/submaps/world_mesh.h"

namespace depth_fusion {
namespace {

// A vertex is as certain as the highest of these that all the voxels about it have.
constexpr std::array<int, 12> kCertainties = {2, 4, 8, 16, 32, 48, 64, 96, 128, 160, 192, 224};

TriangleMesh surfaceOf(ComputeContext& compute, SubmapCollection& submaps, int min_certainty) {
  SurfaceMeshParameters parameters;
  parameters.min_certainty = min_certainty;
  TriangleMesh mesh;
  WorldSnapshot world(submaps);
  exportWorldMesh(compute, world, mesh, parameters, world.hasColor());
  return mesh;
}

using Bits = std::array<uint32_t, 3>;

Bits bitsOf(const MeshVertex& vertex) {
  Bits bits;
  std::memcpy(bits.data(), vertex.position_W.data(), sizeof(bits));
  return bits;
}

// The vertices of a surface are those, bit for bit, that one of less certainty has there, too.
std::vector<float> certaintiesOf(ComputeContext& compute, SubmapCollection& submaps,
                                 const TriangleMesh& mesh) {
  std::vector<float> certainties(mesh.vertices.size(), 0.0f);
  for (size_t i = 0; i < kCertainties.size(); ++i) {
    const TriangleMesh certain = surfaceOf(compute, submaps, kCertainties[i]);
    if (certain.vertices.empty()) break;
    std::vector<Bits> places;
    for (const MeshVertex& vertex : certain.vertices) places.push_back(bitsOf(vertex));
    std::sort(places.begin(), places.end());
    for (size_t vertex = 0; vertex < certainties.size(); ++vertex) {
      if (std::binary_search(places.begin(), places.end(), bitsOf(mesh.vertices[vertex])))
        certainties[vertex] = static_cast<float>(i + 1) / static_cast<float>(kCertainties.size());
    }
  }
  return certainties;
}

}  // namespace

ViewedModel readStoredModel(const std::string& location, bool with_certainty, const std::string& device) {
  const std::unique_ptr<Database> stored = openDatabase(location, DatabaseAccess::kRead);
  const MapDescription description = describeMap(*stored);
  PipelineParameters parameters;
  adoptParameters(description, parameters);
  const auto& layers = description.layers;
  parameters.map.color = std::find(layers.begin(), layers.end(), kColorLayer) != layers.end();
  ComputeContext compute(device);
  BlockMap map(compute, parameters.map);
  SubmapCollection submaps(map, parameters.submaps);
  ReadMap read(*stored, submaps);
  ViewedModel model;
  for (const KeyframePtr& keyframe : read.loaded().keyframes)
    model.way.push_back({keyframe->stamp_s, keyframe->T_W_D});
  std::sort(model.way.begin(), model.way.end(),
            [](const StampedPose& a, const StampedPose& b) { return a.stamp_s < b.stamp_s; });
  read.moveTo(submaps);
  model.mesh = surfaceOf(compute, submaps, SurfaceMeshParameters().min_certainty);
  if (with_certainty) model.certainties = certaintiesOf(compute, submaps, model.mesh);
  return model;
}

}  // namespace depth_fusion
