// A flat grid of where a robot that drives can go, as maps of ROS have it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "depth_fusion/esdf/esdf_grid.h"
#include "depth_fusion/esdf/floor_grid_parameters.h"

namespace depth_fusion {

constexpr int8_t kFloorUnknown = -1, kFloorFree = 0, kFloorOccupied = 100;

// Cells of a rectangle of W, row by row along x, the rows along y.
struct FloorGrid {
  double cell_size_m = 0.0;
  Eigen::Vector2i first =
      Eigen::Vector2i::Zero();  // column and row of the first cell, counted from W's origin
  int columns = 0, rows = 0;
  std::vector<int8_t> cells;

  size_t place(int column, int row) const {
    return static_cast<size_t>(column) + static_cast<size_t>(columns) * static_cast<size_t>(row);
  }
  Eigen::Vector2d origin_m() const { return cell_size_m * first.cast<double>(); }
  // Returns the state of the cell at a point of W; it is unknown outside.
  int8_t at(const Eigen::Vector2d& p_W) const;
  bool isAlike(const FloorGrid& other) const {
    return first == other.first && columns == other.columns && rows == other.rows;
  }
};

// Makes the grid of W, whose z points up: a cell is occupied if a surface is between the two heights above
// the ground there, free if some of it is known to be and nothing is occupied, else unknown.
FloorGrid floorGridOf(const EsdfGrid& space, const FloorGridParameters& parameters);

// Writes PATH.pgm and PATH.yaml as map_saver does. Throws Error if it cannot, or if the grid has no cells.
void writeFloorGrid(const std::string& path, const FloorGrid& grid);

}  // namespace depth_fusion
