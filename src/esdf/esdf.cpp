#include "depth_fusion/esdf/esdf.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "depth_fusion/compute/device_image.h"
#include "esdf/cell_lists.h"
#include "esdf/distance_field.h"

namespace depth_fusion {
namespace {

constexpr size_t kBytesPerCell = 9;   // six on the device, three here
constexpr float kReachMargin = 2.0f;  // cells between a distance and the one that a site was chosen by
constexpr size_t kBlocksAtOnce = 256;

size_t maxBlocks(const EsdfParameters& parameters) {
  return std::max<size_t>((static_cast<size_t>(parameters.memory_mib) << 20) / (kBytesPerCell * ESDF_CELLS),
                          1);
}

EsdfParameters validated(EsdfParameters parameters) {
  validate(parameters.table());
  return parameters;
}

// How far apart they are at least, in cells.
float cellsBetween(const BlockIndex& a, const BlockIndex& b) {
  const Eigen::Array3i apart = ((a - b).array().abs() - 1).max(0);
  return ESDF_BLOCK * apart.cast<float>().matrix().norm();
}

}  // namespace

Esdf::Esdf(ComputeContext& compute, BlockMap& map, const EsdfParameters& parameters)
    : compute_(compute), map_(map), parameters_(validated(parameters)), changes_(map.follow()), grid_(1, 1) {
  const EsdfArgs args = esdfArgs(parameters_, map.parameters());
  blocks_per_axis_ = ESDF_BLOCK * args.cell_voxels / map.parameters().block_size;
  kernels_ = std::make_unique<EsdfKernels>(compute, map.parameters(), args);
  cells_ = std::make_unique<CellPool>(compute, maxBlocks(parameters_));
  lists_ = std::make_unique<CellLists>(compute, *kernels_);
  field_ = std::make_unique<DistanceField>(compute, *kernels_, *cells_);
  grid_ = EsdfGrid(args.cell_m, args.max_distance_m);
}

Esdf::~Esdf() = default;

void Esdf::forgetAll() {
  cells_->forgetAll();
  grid_.blocks().clear();
  for (BlockSet* blocks : {&stale_, &known_changed_, &sites_changed_}) blocks->clear();
  reach_.clear();
  problem_.clear();
}

BlockIndex Esdf::blockOf(const BlockIndex& of_map) const {
  return of_map.unaryExpr([n = blocks_per_axis_](int i) { return i >= 0 ? i / n : -((-i - 1) / n) - 1; });
}

BlockBox Esdf::boxOf(const BlockIndex& block) const {
  return cubeFrom(blocks_per_axis_ * block, blocks_per_axis_);
}

bool Esdf::readMap(StageTimers& timers) {
  const StageTimers::Scope timer(timers, "esdf/read_map");
  const MapChanges changes = changes_.take();
  const bool is_new = changes.generation != generation_;
  if (is_new) forgetAll();
  generation_ = changes.generation;
  for (const auto* blocks : {&changes.updated, &changes.released, &changes.evicted}) {
    for (const BlockIndex& block : *blocks) stale_.insert(blockOf(block));
  }
  if (changes.complete) {
    for (const auto& [block, slot] : cells_->slots()) stale_.insert(block);
    for (const BlockBox& box : elsewhere_ ? elsewhere_->boxes() : std::vector<BlockBox>()) {
      forEachIn(BlockBox(blockOf(box.min()), blockOf(box.max())),
                [&](const BlockIndex& block) { stale_.insert(block); });
    }
  }
  std::vector<BlockIndex> in_pool;
  for (const BlockIndex& block : stale_) {
    BlockMap* elsewhere = elsewhere_ ? elsewhere_->load(boxOf(block)) : nullptr;
    if (elsewhere) {
      readSurface(*elsewhere, {block});
    } else {
      in_pool.push_back(block);
    }
  }
  for (size_t i = 0; i < in_pool.size(); i += kBlocksAtOnce) {
    const auto begin = in_pool.begin() + static_cast<std::ptrdiff_t>(i);
    readSurface(map_,
                {begin, begin + static_cast<std::ptrdiff_t>(std::min(kBlocksAtOnce, in_pool.size() - i))});
  }
  stale_.clear();
  return is_new;
}

void Esdf::readSurface(BlockMap& map, const std::vector<BlockIndex>& blocks) {
  std::map<BlockIndex, std::vector<int>, BlockOrder> slots_of;
  for (const BlockIndex& block : blocks) slots_of[block];
  for (int slot = 0; slot < map.slots().bound(); ++slot) {
    if (!map.slots().inUse(slot)) continue;
    const auto found = slots_of.find(blockOf(map.slots().blockOf(slot)));
    if (found != slots_of.end()) found->second.push_back(slot);
  }
  std::vector<BlockIndex> read;
  std::vector<int> slots, places, cell_slots;
  for (const auto& [block, of_block] : slots_of) {
    if (of_block.empty() && cells_->find(block) < 0) continue;
    const int cell_slot = cells_->findOrMake(block);
    if (cell_slot < 0) {
      problem_ = "what is far from where the map began is left out of the distances; raise esdf/memory_mib";
      continue;
    }
    slots.insert(slots.end(), of_block.begin(), of_block.end());
    places.insert(places.end(), of_block.size(), static_cast<int>(read.size()));
    cell_slots.push_back(cell_slot);
    read.push_back(block);
  }
  if (!read.empty()) noteChanges(read, lists_->read(map, slots, places, cell_slots, *cells_));
}

void Esdf::noteChanges(const std::vector<BlockIndex>& blocks, const std::vector<int>& changes) {
  for (size_t i = 0; i < blocks.size(); ++i) {
    if ((changes[i] & ESDF_SITES_CHANGED) != 0) sites_changed_.insert(blocks[i]);
    if (changes[i] != 0) known_changed_.insert(blocks[i]);
  }
}

void Esdf::see(const DepthFrame& frame, const Pose& T_W_D, StageTimers& timers) {
  const StageTimers::Scope timer(timers, "esdf/see_free");
  see(frame.raw_depth, FreeSpaceView(frame, T_W_D));
}

void Esdf::see(const cv::Mat& depth_m, const CameraIntrinsics& camera, const Pose& T_W_D) {
  DeviceBuffer depth = zeroImage(compute_, camera);
  writeImage(depth, camera, depth_m);
  see(depth, FreeSpaceView(depth_m, camera, T_W_D));
}

void Esdf::see(const DeviceBuffer& depth, const FreeSpaceView& view) {
  std::vector<BlockIndex> blocks;
  std::vector<int> slots;
  for (const BlockIndex& block : view.blocks(ESDF_BLOCK * grid_.cellSize_m())) {
    const int slot = cells_->findOrMake(block);
    if (slot < 0) {
      problem_ = "free space is left out of the distances; raise esdf/memory_mib";
      continue;
    }
    blocks.push_back(block);
    slots.push_back(slot);
  }
  if (!blocks.empty()) noteChanges(blocks, lists_->see(depth, view, blocks, slots, *cells_));
}

void Esdf::computeAll() {
  for (const auto& [block, slot] : cells_->slots()) known_changed_.insert(block);
}

std::vector<BlockIndex> Esdf::dirtyBlocks() const {
  BlockSet dirty = known_changed_;
  BlockBox about;
  for (const BlockIndex& block : sites_changed_) about.extend(block);
  for (const auto& [block, reach] : reach_) {
    if (about.isEmpty() || dirty.count(block) > 0) continue;
    const auto isInReach = [&here = block, far = reach](const BlockIndex& changed) {
      return cellsBetween(here, changed) <= far;
    };
    const BlockIndex nearest = block.cwiseMax(about.min()).cwiseMin(about.max());
    if (isInReach(nearest) && std::any_of(sites_changed_.begin(), sites_changed_.end(), isInReach))
      dirty.insert(block);
  }
  return {dirty.begin(), dirty.end()};
}

std::vector<BlockIndex> Esdf::update(StageTimers& timers) {
  const StageTimers::Scope timer(timers, "esdf/update");
  const std::vector<BlockIndex> dirty = dirtyBlocks();
  const float step_cells = grid_.stepSize_m() / static_cast<float>(grid_.cellSize_m());
  field_->compute(dirty, [&](const BlockIndex& index, const int32_t* cells) {
    EsdfGrid::Block block;
    block.steps.resize(ESDF_CELLS);
    block.states.resize(ESDF_CELLS);
    int farthest = -1;
    bool is_known = false;
    for (size_t n = 0; n < ESDF_CELLS; ++n) {
      block.steps[n] = static_cast<int16_t>(cells[n] & 0xffff);
      block.states[n] = static_cast<CellState>(static_cast<int8_t>(cells[n] >> 16 & 0xff));
      is_known = is_known || block.states[n] != CellState::kUnknown;
      if (block.steps[n] != EsdfGrid::kUnknownSteps)
        farthest = std::max(farthest, std::abs(int{block.steps[n]}));
    }
    reach_[index] = farthest < 0 ? -1.0f : step_cells * static_cast<float>(farthest) + kReachMargin;
    if (is_known) {
      grid_.blocks()[index] = std::move(block);
    } else {
      grid_.blocks().erase(index);
    }
  });
  known_changed_.clear();
  sites_changed_.clear();
  return dirty;
}

}  // namespace depth_fusion
