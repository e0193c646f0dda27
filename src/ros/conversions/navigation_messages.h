// What is known of space, as messages for planners.
#pragma once

#include <map_msgs/OccupancyGridUpdate.h>
#include <nav_msgs/OccupancyGrid.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/PointCloud2.h>

#include <optional>
#include <vector>

#include "depth_fusion/esdf/floor_grid.h"
#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// x, y, z and the distance as intensity, in metres, of the cells whose distance is known: of all, or of those
// at a height.
sensor_msgs::PointCloud2 makeDistanceCloud(const std_msgs::Header& header, const EsdfGrid& space,
                                           std::optional<double> z_m = std::nullopt);
// The middles of the occupied cells.
sensor_msgs::PointCloud2 makeOccupiedCloud(const std_msgs::Header& header, const EsdfGrid& space);

nav_msgs::OccupancyGrid makeOccupancyGrid(const std_msgs::Header& header, const FloorGrid& grid);
// The rectangle in which two grids of the same cells differ; none if they do not.
std::optional<map_msgs::OccupancyGridUpdate> makeGridUpdate(const std_msgs::Header& header,
                                                            const FloorGrid& before, const FloorGrid& now);

// What a scanner sees of the grid that turns in the plane of x and y of a frame L, all around.
struct FloorScan {
  static constexpr int kBeams = 720;
  double max_range_m = 0.0;
  std::vector<float> ranges_m;          // from -pi on; infinite: nothing is there; NaN: not known
  std::vector<Eigen::Vector2d> points;  // of L: of the occupied cells in range, and, where all is free, at it
};
FloorScan scanFloor(const FloorGrid& grid, const Pose& T_W_L, double max_range_m);
sensor_msgs::LaserScan makeLaserScan(const std_msgs::Header& header, const FloorScan& scan);
sensor_msgs::PointCloud2 makeObstacleCloud(const std_msgs::Header& header, const FloorScan& scan);

}  // namespace depth_fusion
