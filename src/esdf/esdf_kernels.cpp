#include "esdf/esdf_kernels.h"

#include <algorithm>
#include <cmath>

#include "depth_fusion/esdf/esdf_grid.h"
#include "geometry/kernel_args.h"
#include "map/map_args.h"

namespace depth_fusion {
namespace {

static_assert(ESDF_BLOCK == EsdfGrid::kBlockCells, "host and device have blocks of one size");
static_assert(ESDF_UNKNOWN == EsdfGrid::kUnknownSteps, "host and device mean the same by it");

constexpr float kHidden_cells = 4.0f;
constexpr char kSites[] = "esdf/nearest_sites.cl";

}  // namespace

EsdfArgs esdfArgs(const EsdfParameters& parameters, const MapParameters& map) {
  // Cells of a block fill whole blocks of the map.
  const int multiple = std::max(1, map.block_size / ESDF_BLOCK);
  const int wanted = static_cast<int>(std::lround(parameters.voxel_size_m / map.voxel_size_m));
  const int rounded = (wanted + multiple - 1) / multiple * multiple;
  EsdfArgs args{};
  args.cell_voxels = std::clamp(rounded, multiple, ESDF_MAX_CELL_VOXELS);
  args.voxel_m = map.voxel_size_m;
  args.cell_m = map.voxel_size_m * static_cast<float>(args.cell_voxels);
  args.truncation_m = map.truncation_m;
  // A surface, however it lies, has some voxel within half a voxel of it; one step is for its rounding.
  args.surface_steps =
      std::min(static_cast<int>(0.5f * TSDF_MAX * map.voxel_size_m / map.truncation_m) + 1, TSDF_MAX);
  args.reach = static_cast<int>(std::ceil(parameters.max_distance_m / args.cell_m)) + 1;
  check(args.reach <= ESDF_MAX_REACH, "esdf/max_distance_m is " + std::to_string(args.reach - 1) +
                                          " cells of " + std::to_string(args.cell_m) +
                                          " m; 118 are the most: lower it, or raise esdf/voxel_size_m");
  args.max_distance_m = parameters.max_distance_m;
  args.steps_per_m = 1.0f / EsdfGrid(args.cell_m, parameters.max_distance_m).stepSize_m();
  args.hidden_m = kHidden_cells * args.cell_m;
  return args;
}

EsdfKernels::EsdfKernels(ComputeContext& compute, const MapParameters& map, const EsdfArgs& args)
    : simd_width_(compute.impl().simd_width),
      args_(args),
      read_(compute, "esdf/read_surface.cl", "read_surface", blockSizeOption(map)),
      adopt_(compute, "esdf/read_surface.cl", "adopt_surface", blockSizeOption(map)),
      see_(compute, "esdf/see_free.cl", "see_free"),
      along_z_(compute, kSites, "nearest_along_z"),
      along_y_(compute, kSites, "nearest_along_y"),
      along_x_(compute, kSites, "nearest_along_x") {}

void EsdfKernels::readSurface(BlockMap& map, const DeviceBuffer& slots, const DeviceBuffer& places, int count,
                              DeviceBuffer& sites, DeviceBuffer& middles) {
  read_.run(static_cast<size_t>(count), map.layer(kTsdfLayer), map.blockIndices(), slots, places, count,
            sites, middles, args_);
}

void EsdfKernels::adoptSurface(const DeviceBuffer& new_sites, const DeviceBuffer& new_middles,
                               const DeviceBuffer& slots, int count, CellPool& cells, DeviceBuffer& changes) {
  adopt_.run(static_cast<size_t>(count) * ESDF_BLOCK * ESDF_BLOCK, new_sites, new_middles, slots, count,
             cells.sites(), cells.middles(), changes);
}

void EsdfKernels::seeFree(const DeviceBuffer& depth, const FreeSpaceView& view, const DeviceBuffer& blocks,
                          int count, CellPool& cells, DeviceBuffer& changes) {
  see_.run(static_cast<size_t>(count) * ESDF_CELLS / simd_width_, depth, blocks, count, cells.seen(), changes,
           view.sight(), view.doubt(), toArgs(view.camera()), toArgs(view.T_D_W()), view.sensor(), args_);
}

void EsdfKernels::nearestAlongZ(const DeviceBuffer& slots, const CellPool& cells, DeviceBuffer& along_z,
                                const EsdfRegionArgs& region) {
  along_z_.run2d(ESDF_BLOCK * region.blocks[0] / simd_width_, ESDF_BLOCK * region.blocks[1], slots,
                 cells.sites(), along_z, region, args_);
}

void EsdfKernels::nearestAlongY(const DeviceBuffer& along_z, DeviceBuffer& planes,
                                const EsdfRegionArgs& region) {
  along_y_.run2d(ESDF_BLOCK * region.blocks[0] / simd_width_, region.size[1] * region.size[2], along_z,
                 planes, region, args_);
}

void EsdfKernels::nearestAlongX(const DeviceBuffer& slots, const CellPool& cells, const DeviceBuffer& planes,
                                const DeviceBuffer& blocks, int count, DeviceBuffer& results,
                                const EsdfRegionArgs& region) {
  along_x_.run(static_cast<size_t>(count) * ESDF_CELLS / simd_width_, slots, cells.sites(), cells.middles(),
               cells.seen(), planes, blocks, count, results, region, args_);
}

}  // namespace depth_fusion
