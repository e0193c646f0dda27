#include "model_view/mesh_renderer.h"

#include <algorithm>

#include "depth_fusion/common/error.h"
#include "geometry/kernel_args.h"
#include "shared/types.h"

namespace depth_fusion {
namespace {

constexpr int kMinCertainty = 1;
constexpr size_t kMaxBatchBlocks = 3072;
constexpr size_t kMembersPerCore = 8;   // at most: itself and the seven blocks beyond its far sides
constexpr size_t kProjectedBytes = 16;  // a vertex
constexpr int kNoPlace = -1;

}  // namespace

MeshRenderer::MeshRenderer(ComputeContext& compute, BlockMap& map, const CameraIntrinsics& camera)
    : compute_(compute),
      map_(map),
      mesh_(compute, map, kMinCertainty, kMaxBatchBlocks),
      kernels_(compute, map),
      max_cores_(std::max<size_t>(mesh_.limits().blocks / 2, 1)),
      listed_(compute, map.usage().capacity * sizeof(int), "the list of blocks in view"),
      count_(compute, sizeof(int), "a list's length"),
      places_(compute, map.usage().capacity * sizeof(int), "the places of blocks in a batch"),
      members_(compute, kMembersPerCore * max_cores_ * sizeof(int), "the blocks of a batch"),
      firsts_(compute, mesh_.limits().blocks * sizeof(SurfaceMeshKernels::Totals), "the numbers of a batch"),
      projected_(compute, mesh_.limits().vertices * kProjectedBytes, "projected vertices"),
      drawn_(compute, mesh_.limits().triangles * sizeof(int), "the triangles that are drawn"),
      nearest_(compute, imageElements(camera) * sizeof(int), "the depth of triangles") {
  places_.fill(kNoPlace, places_.bytes());
}

void MeshRenderer::render(ModelView& view, float min_range_m, float max_range_m, StageTimers& timers) {
  const Range range{min_range_m, max_range_m};
  nearest_.fill(NO_DEPTH_BITS, nearest_.bytes());
  view.normals.fill(0, view.normals.bytes());
  std::vector<int> slots;
  {
    const StageTimers::Scope timer(timers, "model_view/list_blocks");
    slots = listBlocks(view, range);
  }
  const StageTimers::Scope timer(timers, "model_view/triangles");
  for (size_t begin = 0; begin < slots.size(); begin += max_cores_) {
    const size_t end = std::min(begin + max_cores_, slots.size());
    drawBlocks(slots.data() + begin, slots.data() + end, view, range);
  }
  kernels_.resolveDepth(view, nearest_);
  compute_.finish();
}

std::vector<int> MeshRenderer::listBlocks(const ModelView& view, const Range& range) {
  count_.fill(0, sizeof(int));
  kernels_.listSurfaceBlocks(map_, listed_, count_, view, range.min_m, range.max_m);
  const std::vector<int> slots = listed_.read<int>(count_.read<int>(1).front());
  std::vector<std::pair<uint64_t, int>> ordered;
  for (const int slot : slots)
    ordered.emplace_back(meshBlock(map_.window().origin, map_.slots().blockOf(slot)).morton_code, slot);
  std::sort(ordered.begin(), ordered.end());
  std::vector<int> result;
  for (const auto& [morton_code, slot] : ordered) result.push_back(slot);
  return result;
}

void MeshRenderer::drawBlocks(const int* begin, const int* end, ModelView& view, const Range& range) {
  if (const std::optional<Batch> batch = polygonise(begin, end)) {
    rasterise(*batch, view, range);
    return;
  }
  check(end - begin > 1, "a block has more triangles than a batch holds; see model_view/renderer");
  const int* middle = begin + (end - begin) / 2;
  drawBlocks(begin, middle, view, range);
  drawBlocks(middle, end, view, range);
}

std::optional<MeshRenderer::Batch> MeshRenderer::polygonise(const int* begin, const int* end) {
  Batch batch;
  batch.cores = static_cast<int>(end - begin);
  members_.write(begin, batch.cores * sizeof(int));
  count_.write(&batch.cores, sizeof(int));
  kernels_.placeMembers(map_, members_, places_, count_, batch.cores);
  batch.members = count_.read<int>(1).front();
  const BatchLimits& limits = mesh_.limits();
  const bool fits = static_cast<size_t>(batch.members) <= limits.blocks;
  if (fits) {
    kernels_.describeMembers(map_, mesh_.blockArgs(), members_, places_, batch.cores, batch.members);
    mesh_.classify(static_cast<size_t>(batch.members));
    number(batch);
  }
  kernels_.clearPlaces(members_, places_, batch.members);
  if (!fits || batch.vertices > limits.vertices || batch.triangles > limits.triangles) return std::nullopt;
  return batch;
}

void MeshRenderer::number(Batch& batch) {
  std::vector<SurfaceMeshKernels::Totals> firsts = mesh_.totals(batch.members);
  for (int i = 0; i < batch.members; ++i) {
    const SurfaceMeshKernels::Totals of_block = firsts[i];
    firsts[i] = {batch.vertices, batch.triangles};
    batch.vertices += of_block.vertices;
    if (i < batch.cores) batch.triangles += of_block.triangles;
  }
  firsts_.write(firsts);
  kernels_.numberMembers(mesh_.blockArgs(), firsts_, batch.members);
}

void MeshRenderer::rasterise(const Batch& batch, ModelView& view, const Range& range) {
  const DeviceBuffer& vertices = mesh_.emitVertices(static_cast<size_t>(batch.members), 0);
  const DeviceBuffer& triangles = mesh_.emitTriangles(static_cast<size_t>(batch.cores));
  const int count = static_cast<int>(batch.triangles);
  kernels_.projectVertices(projected_, vertices, static_cast<int>(batch.vertices), view);
  count_.fill(0, sizeof(int));
  kernels_.rasteriseDepth(view, nearest_, drawn_, count_, projected_, triangles, count, range.min_m,
                          range.max_m);
  kernels_.rasteriseNormals(view, nearest_, drawn_, projected_, vertices, triangles,
                            count_.read<int>(1).front());
}

}  // namespace depth_fusion
