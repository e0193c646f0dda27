#include "surface_mesh/surface_mesh_kernels.h"

#include <algorithm>

#include "map/map_args.h"
#include "surface_mesh/marching_cubes_table.h"

namespace depth_fusion {
namespace {

constexpr const char* kPurpose = "the surface mesh";
constexpr size_t kVolumeScratchBytes = size_t{16} << 20;
// The bound is more than the largest block can need, 3 * 32^3 vertices and 5 * 32^3 triangles.
constexpr size_t kBatchVertices = size_t{1} << 18;
constexpr size_t kBatchTriangles = size_t{1} << 19;
constexpr size_t kRowMaskBytes = 16;
constexpr size_t kRowBytes = 16;
constexpr size_t kColorBytes = 4;

static_assert(sizeof(MeshVertex) == 24, "a vertex is six floats in kernels and files");
static_assert(sizeof(MeshTriangle) == 12, "a triangle is three integers in kernels and files");

size_t fittingBlocks(const MapParameters& map, size_t max_batch_blocks) {
  const size_t rows = static_cast<size_t>(map.block_size) * map.block_size;
  const size_t padded = map.block_size + 3;
  const size_t block_bytes =
      padded * padded * (padded + kRowMaskBytes) + rows * (kRowBytes + sizeof(uint32_t));
  return std::min(max_batch_blocks, kVolumeScratchBytes / block_bytes);
}

}  // namespace

SurfaceMeshKernels::SurfaceMeshKernels(ComputeContext& compute, BlockMap& map, int min_certainty,
                                       size_t max_batch_blocks)
    : map_(map),
      min_certainty_(min_certainty),
      rows_(static_cast<size_t>(map.parameters().block_size) * map.parameters().block_size),
      padded_size_(static_cast<size_t>(map.parameters().block_size) + 3),
      limits_{fittingBlocks(map.parameters(), max_batch_blocks), kBatchVertices, kBatchTriangles},
      table_(compute, kCubeCases * kCubeCaseBytes, kPurpose),
      block_args_(compute, limits_.blocks * sizeof(MeshBlockArgs), kPurpose),
      volume_(compute, limits_.blocks * padded_size_ * padded_size_ * padded_size_, kPurpose),
      row_masks_(compute, limits_.blocks * padded_size_ * padded_size_ * kRowMaskBytes, kPurpose),
      row_vertices_(compute, limits_.blocks * rows_ * kRowBytes, kPurpose),
      row_triangles_(compute, limits_.blocks * rows_ * sizeof(uint32_t), kPurpose),
      totals_(compute, limits_.blocks * sizeof(Totals), kPurpose),
      vertices_(compute, kBatchVertices * sizeof(MeshVertex), kPurpose),
      vertex_colors_(compute, map.hasLayer(kColorLayer) ? kBatchVertices * kColorBytes : 1, kPurpose),
      triangles_(compute, kBatchTriangles * sizeof(MeshTriangle), kPurpose),
      gather_(compute, "surface_mesh/gather_blocks.cl", "gather_blocks", blockSizeOption(map.parameters())),
      classify_(compute, "surface_mesh/classify_rows.cl", "classify_rows", blockSizeOption(map.parameters())),
      scan_(compute, "surface_mesh/classify_rows.cl", "scan_rows", blockSizeOption(map.parameters())),
      emit_vertices_(compute, "surface_mesh/emit_vertices.cl", "emit_vertices",
                     blockSizeOption(map.parameters())),
      color_vertices_(compute, "surface_mesh/color_vertices.cl", "color_vertices",
                      blockSizeOption(map.parameters())),
      emit_triangles_(compute, "surface_mesh/emit_triangles.cl", "emit_triangles",
                      blockSizeOption(map.parameters())) {
  table_.write(marchingCubesTable());
}

size_t SurfaceMeshKernels::deviceBytes() const {
  size_t bytes = 0;
  for (const DeviceBuffer* buffer : {&table_, &block_args_, &volume_, &row_masks_, &row_vertices_,
                                     &row_triangles_, &totals_, &vertices_, &vertex_colors_, &triangles_}) {
    bytes += buffer->bytes();
  }
  return bytes;
}

void SurfaceMeshKernels::classify(const std::vector<MeshBlockArgs>& blocks) {
  block_args_.write(blocks);
  classify(blocks.size());
}

void SurfaceMeshKernels::classify(size_t count) {
  const int blocks = static_cast<int>(count);
  gather_.run(count * padded_size_, volume_, row_masks_, map_.layer(kTsdfLayer), map_.offsets(), block_args_,
              blocks, min_certainty_, gridArgs(map_));
  classify_.run(count * rows_, row_vertices_, row_triangles_, row_masks_, table_, blocks);
  scan_.run(count, row_vertices_, row_triangles_, totals_, blocks);
}

std::vector<SurfaceMeshKernels::Totals> SurfaceMeshKernels::totals(size_t count) const {
  return totals_.read<Totals>(count);
}

void SurfaceMeshKernels::emitVertices(const MeshBatch& batch, std::vector<MeshVertex>& vertices) {
  emitVertices(batch.core_blocks, batch.first_vertex);
  vertices.resize(batch.vertices);
  vertices_.read(vertices.data(), vertices.size() * sizeof(MeshVertex));
}

void SurfaceMeshKernels::colorVertices(const MeshBatch& batch, std::vector<MeshColor>& colors) {
  color_vertices_.run(batch.vertices, vertex_colors_, vertices_, map_.offsets(), map_.layer(kColorLayer),
                      static_cast<int>(batch.vertices), gridArgs(map_));
  const auto rgba = vertex_colors_.read<std::array<uint8_t, kColorBytes>>(batch.vertices);
  colors.resize(batch.vertices);
  std::transform(rgba.begin(), rgba.end(), colors.begin(), [](const auto& c) {
    return MeshColor{c[0], c[1], c[2]};
  });
}

void SurfaceMeshKernels::emitTriangles(const MeshBatch& batch, std::vector<MeshTriangle>& triangles) {
  emitTriangles(batch.core_blocks);
  triangles.resize(batch.triangles);
  triangles_.read(triangles.data(), triangles.size() * sizeof(MeshTriangle));
}

const DeviceBuffer& SurfaceMeshKernels::emitVertices(size_t count, uint32_t first_vertex) {
  emit_vertices_.run(count * rows_, vertices_, volume_, row_vertices_, block_args_, static_cast<int>(count),
                     first_vertex, map_.parameters().voxel_size_m);
  return vertices_;
}

const DeviceBuffer& SurfaceMeshKernels::emitTriangles(size_t count) {
  emit_triangles_.run(count * rows_, triangles_, row_masks_, row_vertices_, row_triangles_, table_,
                      block_args_, static_cast<int>(count));
  return triangles_;
}

}  // namespace depth_fusion
