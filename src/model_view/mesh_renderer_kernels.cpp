#include "model_view/mesh_renderer_kernels.h"

#include "geometry/kernel_args.h"
#include "map/map_args.h"

namespace depth_fusion {
namespace {

constexpr char kBlocks[] = "model_view/list_mesh_blocks.cl",
               kTriangles[] = "model_view/rasterise_triangles.cl";

TransformArgs fromWorld(const ModelView& view) { return toArgs(Pose(view.T_W_D.inverse())); }

}  // namespace

MeshRendererKernels::MeshRendererKernels(ComputeContext& compute, const BlockMap& map)
    : in_view_(compute, map),
      list_(compute, kBlocks, "list_surface_blocks", blockSizeOption(map.parameters())),
      place_cores_(compute, kBlocks, "place_cores", blockSizeOption(map.parameters())),
      place_lenders_(compute, kBlocks, "place_lenders", blockSizeOption(map.parameters())),
      describe_(compute, kBlocks, "describe_members", blockSizeOption(map.parameters())),
      number_(compute, kBlocks, "number_members", blockSizeOption(map.parameters())),
      clear_(compute, kBlocks, "clear_places", blockSizeOption(map.parameters())),
      project_(compute, kTriangles, "project_vertices"),
      depth_(compute, kTriangles, "rasterise_depth"),
      normals_(compute, kTriangles, "rasterise_normals"),
      resolve_(compute, kTriangles, "resolve_depth") {}

void MeshRendererKernels::listSurfaceBlocks(BlockMap& map, DeviceBuffer& listed, DeviceBuffer& count,
                                            const ModelView& view, float min_range_m, float max_range_m) {
  in_view_.list(map, view.camera, view.T_W_D.inverse(), max_range_m);
  list_.run(in_view_.slots(), in_view_.groups(), in_view_.groupCount(), map.slots().bound(),
            map.blockIndices(), map.blockStates(), listed, count, toArgs(view.camera), fromWorld(view),
            gridArgs(map), min_range_m, max_range_m);
}

void MeshRendererKernels::placeMembers(BlockMap& map, DeviceBuffer& members, DeviceBuffer& places,
                                       DeviceBuffer& count, int cores) {
  place_cores_.run(cores, members, places, cores);
  place_lenders_.run(cores, members, places, count, map.blockIndices(), map.offsets(), cores, gridArgs(map));
}

void MeshRendererKernels::describeMembers(BlockMap& map, DeviceBuffer& blocks, const DeviceBuffer& members,
                                          const DeviceBuffer& places, int cores, int count) {
  describe_.run(count, blocks, members, places, map.blockIndices(), map.offsets(), cores, count,
                gridArgs(map));
}

void MeshRendererKernels::numberMembers(DeviceBuffer& blocks, const DeviceBuffer& firsts, int count) {
  number_.run(count, blocks, firsts, count);
}

void MeshRendererKernels::clearPlaces(const DeviceBuffer& members, DeviceBuffer& places, int count) {
  clear_.run(count, members, places, count);
}

void MeshRendererKernels::projectVertices(DeviceBuffer& projected, const DeviceBuffer& vertices, int count,
                                          const ModelView& view) {
  project_.run(count, projected, vertices, count, toArgs(view.camera), fromWorld(view));
}

void MeshRendererKernels::rasteriseDepth(ModelView& view, DeviceBuffer& nearest, DeviceBuffer& drawn,
                                         DeviceBuffer& drawn_count, const DeviceBuffer& projected,
                                         const DeviceBuffer& triangles, int count, float min_range_m,
                                         float max_range_m) {
  depth_.run(count, view.normals, nearest, drawn, drawn_count, projected, triangles, count,
             toArgs(view.camera), min_range_m, max_range_m);
}

void MeshRendererKernels::rasteriseNormals(ModelView& view, const DeviceBuffer& nearest,
                                           const DeviceBuffer& drawn, const DeviceBuffer& projected,
                                           const DeviceBuffer& vertices, const DeviceBuffer& triangles,
                                           int count) {
  normals_.run(count, view.normals, nearest, drawn, projected, vertices, triangles, count,
               toArgs(view.camera), fromWorld(view));
}

void MeshRendererKernels::resolveDepth(ModelView& view, const DeviceBuffer& nearest) {
  resolve_.run2d(view.camera.width, view.camera.height, view.depth, nearest, toArgs(view.camera));
}

}  // namespace depth_fusion
