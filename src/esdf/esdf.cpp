#include "depth_fusion/esdf/esdf.h"

#include <algorithm>
#include <map>
#include <optional>

#include "depth_fusion/compute/device_image.h"
#include "esdf/cell_lists.h"
#include "esdf/distance_field.h"

namespace depth_fusion {
namespace {

constexpr size_t kBytesPerCell = 9;  // six on the device, three here
constexpr size_t kBlocksAtOnce = 256;

size_t maxBlocks(const EsdfParameters& parameters) {
  return std::max<size_t>((static_cast<size_t>(parameters.memory_mib) << 20) / (kBytesPerCell * ESDF_CELLS),
                          1);
}

EsdfParameters validated(EsdfParameters parameters) {
  validate(parameters.table());
  return parameters;
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

void Esdf::noteStale(const std::vector<BlockIndex>& of_map) {
  std::optional<BlockIndex> last;  // most are where the one before is
  for (const BlockIndex& block : of_map) {
    const BlockIndex here = blockOf(block);
    if (last != here) stale_.insert(here);
    last = here;
  }
}

bool Esdf::readMap(StageTimers& timers) {
  const StageTimers::Scope timer(timers, "esdf/read_map");
  const MapChanges changes = changes_.take();
  const bool is_new = changes.generation != generation_;
  if (is_new) forgetAll();
  generation_ = changes.generation;
  for (const auto* blocks : {&changes.updated, &changes.released, &changes.evicted}) noteStale(*blocks);
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
  auto found = slots_of.end();
  std::optional<BlockIndex> last;
  for (int slot = 0; slot < map.slots().bound(); ++slot) {
    if (!map.slots().inUse(slot)) continue;
    const BlockIndex here = blockOf(map.slots().blockOf(slot));
    if (last != here) found = slots_of.find(here);
    last = here;
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

}  // namespace depth_fusion
