#include "apps/benchmark/kernel_costs.h"

#include <algorithm>
#include <map>

#include "compute/opencl.h"
#include "map/map_args.h"

namespace depth_fusion {
namespace {

// A ray that is followed, one in four, takes so many steps, as counted over tum_fr1_xyz
// (docs/design_notes.md).
constexpr double kRaySteps = 12.0;

}  // namespace

std::optional<KernelCost> kernelCost(const std::string& kernel, const StageFixture::Stage& stage,
                                     StageFixture& fixture) {
  if (kernel == "accumulate_system" && stage.level < 0) return std::nullopt;  // levels of several sizes
  const int width = fixture.compute().impl().simd_width;
  const MapParameters& map = fixture.mapParameters();
  const double voxels = VOXELS_PER_ITEM(width, map.block_size);
  const double band_samples = 2.0 * map.truncation_m / (0.5 * map.voxel_size_m * map.block_size) + 1.0;
  // A work-group of accumulate_system takes a row of its level's image; it has one work-item but on GPUs.
  const double group_items = width == 1 ? static_cast<double>(fixture.compute().impl().group_size) : 1.0;
  const double row_part = (fixture.camera().width >> std::max(stage.level, 0)) / group_items;
  const double rays = RAY_PATCHES(width) * RAY_STRIDE * RAY_STRIDE * static_cast<double>(width);
  // element, elements a work-item, bytes, flops, gathers
  const std::map<std::string, KernelCost> costs = {
      {"depth_to_metres_u16", {"pixel", 1.0 * width, 2 + 4, 2, 0}},
      {"depth_to_metres_f32", {"pixel", 1.0 * width, 4 + 4, 2, 0}},
      {"rectify_depth", {"pixel", 1.0 * width, 4 + 4, 90, 4}},
      {"splat_depth", {"pixel", 1.0 * width, 4 + 4, 40, 1}},
      {"compensate_motion", {"pixel", 1.0 * width, 4 + 4, 80, 2}},
      {"filter_bilateral", {"pixel", 1.0 * width, 4 + 4, 25 * 10 + 10, 0}},
      {"halve_depth", {"pixel", 1.0 * width, 16 + 4, 20, 0}},
      {"compute_normals", {"pixel", 1.0 * width, 4 + 4, 9 * 6 + 30, 0}},
      {"pack_measurements", {"pixel", 1.0 * width, 8 + 4, 55, 0}},
      {"max_tiles", {"pixel", DEPTH_TILE * DEPTH_TILE, 4, 1, 0}},
      {"accumulate_system", {"pixel", row_part, 8, 170, 2}},
      {"request_blocks", {"pixel", 1.0 * width, 4, 40 + 12 * band_samples, band_samples}},
      {"list_visible_blocks", {"block", 1.0 * SLOTS_PER_ITEM(width), 16 + 4, 50, 4}},
      {"integrate_blocks", {"voxel", voxels, 2 + 2, 60, 1}},
      {"splat_block_ranges", {"block", 1, 16 + 4, 150, 4}},
      {"raycast", {"ray", rays, 4 + 4, 150 + 15 * kRaySteps, 16 + kRaySteps / 2}},
      {"rate_pixels", {"pixel", 1.0 * width, 4 + 4 + 4, 25 * 4 + 20, 0}}};
  const auto cost = costs.find(kernel);
  if (cost == costs.end()) return std::nullopt;
  return cost->second;
}

}  // namespace depth_fusion
