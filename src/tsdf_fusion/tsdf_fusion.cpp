#include "depth_fusion/tsdf_fusion/tsdf_fusion.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "depth_fusion/common/error.h"
#include "frames/sensor_args.h"
#include "tsdf_fusion/block_selection.h"
#include "tsdf_fusion/tsdf_fusion_kernels.h"

namespace depth_fusion {
namespace {

TsdfFusionParameters validated(TsdfFusionParameters parameters) {
  validate(parameters.table());
  return parameters;
}

// By the Kalman filter, a distance whose sigma is above half the truncation says nothing any more.
int minCertainty(const TsdfFusionParameters& parameters, const MapParameters& map, float units_per_m2) {
  const float variance = units_per_m2 * (0.25f * map.truncation_m * map.truncation_m);
  return parameters.rule == "kalman" ? std::max(certaintyOf(variance), 1) : 1;
}

}  // namespace

int certaintyOf(float variance) {
  int bits = 0;
  std::memcpy(&bits, &variance, sizeof(bits));
  return std::clamp((VARIANCE_BITS_MAX - bits) / VARIANCE_BITS_STEP + 1, 0, CERTAINTY_MAX);
}

FusionArgs fusionArgs(const TsdfFusionParameters& parameters, const MapParameters& map,
                      const DepthFrame& frame, int frame_number) {
  const DepthSensorParameters& sensor = frame.levels[0].sensor;
  FusionArgs args{};
  args.depth_step_m = frame.depth_step_m;
  args.units_per_m2 = std::pow(VARIANCE_UNIT_SIGMA_M / sensor.sigma_base_m, 2.0f);
  args.variance_at_1m = args.units_per_m2 * std::pow(AXIAL_SIGMA_M(sensor, 1.0f), 2.0f);
  args.gain_at_1m = parameters.gain_at_1m;
  args.weight_at_1m = parameters.weight_at_1m;
  args.max_weight = parameters.max_weight;
  args.process_variance = args.units_per_m2 * (parameters.process_sigma_m * parameters.process_sigma_m);
  args.free_space_sigmas = parameters.free_space_sigmas;
  args.free_space_kept = 1.0f - parameters.free_space_rate;
  args.min_certainty = minCertainty(parameters, map, args.units_per_m2);
  args.frame = frame_number;
  return args;
}

TsdfFusion::TsdfFusion(ComputeContext& compute, BlockMap& map, const TsdfFusionParameters& parameters)
    : compute_(compute),
      map_(map),
      parameters_(validated(parameters)),
      visible_(compute, map.usage().capacity * sizeof(int), "the list of visible blocks"),
      empty_(compute, map.usage().capacity * sizeof(int), "the list of empty blocks"),
      count_(compute, sizeof(int), "a list's length"),
      kernels_(std::make_unique<Kernels>(compute, map, parameters_)),
      selection_(std::make_unique<BlockSelection>(compute, *kernels_)) {}

TsdfFusion::~TsdfFusion() = default;

void TsdfFusion::setParameters(const TsdfFusionParameters& parameters) {
  check(parameters.rule == parameters_.rule && parameters.distance == parameters_.distance,
        "tsdf_fusion/rule and tsdf_fusion/distance cannot change while the map is built");
  parameters_ = validated(parameters);
}

FusionResult TsdfFusion::integrate(const DepthFrame& frame, const Pose& T_W_D, StageTimers& timers) {
  FusionResult result;
  const Pose T_D_W = T_W_D.inverse();
  {
    const StageTimers::Scope timer(timers, "tsdf_fusion/select_blocks");
    allocateBlocks(frame, T_W_D, result);
    count_.fill(0, sizeof(int));
    kernels_->listVisibleBlocks(frame, map_, visible_, count_, T_D_W);
    result.blocks_updated = count_.read<int>(1).front();
  }
  const int visible_count = static_cast<int>(result.blocks_updated);
  {
    const StageTimers::Scope timer(timers, "tsdf_fusion/integrate");
    const FusionArgs args = fusionArgs(parameters_, map_.parameters(), frame, frame_number_++);
    kernels_->integrateBlocks(frame, map_, visible_, visible_count, T_D_W, args);
    compute_.finish();
  }
  {
    const StageTimers::Scope timer(timers, "tsdf_fusion/release_blocks");
    count_.fill(0, sizeof(int));
    kernels_->listEmptyBlocks(map_, visible_, visible_count, empty_, count_);
    std::vector<int> slots = empty_.read<int>(count_.read<int>(1).front());
    std::sort(slots.begin(), slots.end());
    map_.release(slots);
    result.blocks_released = slots.size();
  }
  return result;
}

void TsdfFusion::allocateBlocks(const DepthFrame& frame, const Pose& T_W_D, FusionResult& result) {
  result.points_outside = selection_->select(frame, map_, T_W_D, [&](const std::vector<BlockIndex>& blocks) {
    const size_t allocated = map_.allocate(blocks);
    result.blocks_requested += blocks.size();
    result.blocks_allocated += allocated;
    return allocated == blocks.size();
  });
}

}  // namespace depth_fusion
