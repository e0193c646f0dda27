#include "depth_fusion/esdf/floor_grid.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "common/io/text_file.h"
#include "depth_fusion/common/error.h"
#include "esdf/ground.h"

namespace depth_fusion {

int8_t FloorGrid::at(const Eigen::Vector2d& p_W) const {
  const Eigen::Vector2i cell = (p_W / cell_size_m).array().floor().cast<int>().matrix() - first;
  const bool is_inside = cell.minCoeff() >= 0 && cell.x() < columns && cell.y() < rows;
  return is_inside ? cells[place(cell.x(), cell.y())] : kFloorUnknown;
}

FloorGrid floorGridOf(const EsdfGrid& space, const FloorGridParameters& parameters) {
  FloorGrid grid;
  grid.cell_size_m = space.cellSize_m();
  if (space.blocks().empty()) return grid;
  const Columns columns(space);
  grid.first = columns.first();
  grid.columns = columns.width();
  grid.rows = columns.depth();
  const std::vector<int> ground = groundLevels(columns, grid.cell_size_m, parameters);
  const auto levels = [&](float height_m) {
    return static_cast<int>(std::floor(height_m / grid.cell_size_m + 1e-3));
  };
  const int lowest = levels(parameters.min_height_m) + 1, highest = levels(parameters.max_height_m);
  grid.cells.assign(columns.count(), kFloorUnknown);
  for (size_t column = 0; column < columns.count(); ++column) {
    for (int level = ground[column] + lowest; level <= ground[column] + highest; ++level) {
      const CellState state = columns.at(column, level);
      if (state == CellState::kFree) grid.cells[column] = std::max(grid.cells[column], kFloorFree);
      if (state == CellState::kOccupied) grid.cells[column] = kFloorOccupied;
    }
  }
  return grid;
}

void writeFloorGrid(const std::string& path, const FloorGrid& grid) {
  check(!grid.cells.empty(), "nothing is known of the floor yet; nothing was written");
  std::string image = "P5\n# depth_fusion " + std::to_string(grid.cell_size_m) + " m/pix\n" +
                      std::to_string(grid.columns) + " " + std::to_string(grid.rows) + "\n255\n";
  for (int row = grid.rows - 1; row >= 0; --row) {  // the picture's first row is the highest y
    for (int column = 0; column < grid.columns; ++column) {
      const int8_t cell = grid.cells[grid.place(column, row)];
      image += static_cast<char>(cell == kFloorFree ? 254 : cell == kFloorOccupied ? 0 : 205);
    }
  }
  const Eigen::Vector2d origin = grid.origin_m();
  const std::string name = std::filesystem::path(path).filename().string();
  writeText(path + ".pgm", image);
  writeText(path + ".yaml", "image: " + name + ".pgm\nresolution: " + stampText(grid.cell_size_m) +
                                "\norigin: [" + stampText(origin.x()) + ", " + stampText(origin.y()) +
                                ", 0.000000]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n\n");
}

}  // namespace depth_fusion
