#include "submaps/layer_rows.h"

#include <algorithm>
#include <utility>

#include "depth_fusion/common/error.h"
#include "depth_fusion/map/map_parameters.h"
#include "submaps/row_keys.h"

namespace depth_fusion {

std::vector<LayerRow> storedLayers(const MapDescription& description) {
  MapParameters with_all;
  with_all.color = true;
  const std::vector<LayerRow> known = layersOf(with_all);
  check(!description.layers.empty(), "the map has no layer");
  std::vector<LayerRow> layers;
  for (const std::string& name : description.layers) {
    const auto row =
        std::find_if(known.begin(), known.end(), [&](const auto& layer) { return layer.name == name; });
    check(row != known.end(), "the map has a layer '" + name + "', which this program does not know");
    layers.push_back(*row);
  }
  return layers;
}

int blockSizeOf(const MapDescription& description) {
  MapParameters parameters;
  setParameter(parameters.table(), "block_size", description.parameter("map/block_size"));
  return parameters.block_size;
}

void forEachGroup(const RowSource& rows, uint32_t submap, const LayerRow& layer, int block_size,
                  std::vector<std::string>& problems,
                  const std::function<void(const std::string& key, const std::string& row,
                                           const BlockIndex& index, BlockGroup group)>& visit) {
  const std::string prefix = blocksPrefix(submap, layer.name);
  rows(prefix, [&](const std::string& key, const std::string& row) {
    BlockIndex index;
    BlockGroup group;
    try {
      index = groupOfKey(key, prefix);
      group = parseBlocks(row, index, layer, block_size, "row " + readable(key));
    } catch (const Error& error) {
      problems.emplace_back(error.what());
      return;
    }
    visit(key, row, index, std::move(group));
  });
}

}  // namespace depth_fusion
