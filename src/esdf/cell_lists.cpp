#include "esdf/cell_lists.h"

#include "esdf/cell_pool.h"
#include "map/map_args.h"

namespace depth_fusion {

void CellLists::beginChanges(size_t blocks) {
  ensureBytes(compute_, changes_, blocks * sizeof(int), "what has changed of cells");
  changes_.fill(0, blocks * sizeof(int));
}

std::vector<int> CellLists::read(BlockMap& map, const std::vector<int>& map_slots,
                                 const std::vector<int>& places, const std::vector<int>& cell_slots,
                                 CellPool& cells) {
  const size_t blocks = cell_slots.size();
  beginChanges(blocks);
  ensureBytes(compute_, sites_, blocks * ESDF_CELLS * sizeof(uint32_t), "sites that are read");
  ensureBytes(compute_, middles_, blocks * ESDF_CELLS, "distances that are read");
  sites_.fill(ESDF_NO_SITE, blocks * ESDF_CELLS * sizeof(uint32_t));
  middles_.fill(kAllChi, blocks * ESDF_CELLS);
  if (!map_slots.empty()) {
    ensureBytes(compute_, map_slots_, map_slots.size() * sizeof(int), "blocks to read");
    ensureBytes(compute_, places_, map_slots.size() * sizeof(int), "places of blocks to read");
    map_slots_.write(map_slots);
    places_.write(places);
    kernels_.readSurface(map, map_slots_, places_, static_cast<int>(map_slots.size()), sites_, middles_);
  }
  ensureBytes(compute_, cell_slots_, blocks * sizeof(int), "slots of cells");
  cell_slots_.write(cell_slots);
  kernels_.adoptSurface(sites_, middles_, cell_slots_, static_cast<int>(blocks), cells, changes_);
  return changes_.read<int>(blocks);
}

std::vector<int> CellLists::see(const DeviceBuffer& depth, const FreeSpaceView& view,
                                const std::vector<BlockIndex>& blocks, const std::vector<int>& slots,
                                CellPool& cells) {
  beginChanges(blocks.size());
  std::vector<BlockRequest> list;
  for (size_t i = 0; i < blocks.size(); ++i)
    list.push_back({blocks[i].x(), blocks[i].y(), blocks[i].z(), slots[i]});
  ensureBytes(compute_, blocks_, list.size() * sizeof(BlockRequest), "blocks of cells in view");
  blocks_.write(list);
  kernels_.seeFree(depth, view, blocks_, static_cast<int>(list.size()), cells, changes_);
  return changes_.read<int>(list.size());
}

}  // namespace depth_fusion
