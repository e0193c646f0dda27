#include "ros/conversions/navigation_messages.h"

#include <sensor_msgs/point_cloud2_iterator.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace depth_fusion {
namespace {

constexpr double kBeam_rad = 2.0 * M_PI / FloorScan::kBeams;

// Points with as many fields, x, y and z first, as each of them has values.
sensor_msgs::PointCloud2 makeCloud(const std_msgs::Header& header, const std::vector<float>& values,
                                   bool has_intensity) {
  using sensor_msgs::PointField;
  sensor_msgs::PointCloud2 cloud;
  cloud.header = header;
  cloud.is_dense = true;
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  if (has_intensity) {
    modifier.setPointCloud2Fields(4, "x", 1, PointField::FLOAT32, "y", 1, PointField::FLOAT32, "z", 1,
                                  PointField::FLOAT32, "intensity", 1, PointField::FLOAT32);
  } else {
    modifier.setPointCloud2Fields(3, "x", 1, PointField::FLOAT32, "y", 1, PointField::FLOAT32, "z", 1,
                                  PointField::FLOAT32);
  }
  modifier.resize(values.size() / (has_intensity ? 4 : 3));
  if (!values.empty()) std::memcpy(cloud.data.data(), values.data(), values.size() * sizeof(float));
  return cloud;
}

void append(std::vector<float>& values, const Eigen::Vector3d& p) {
  for (const double coordinate : p) values.push_back(static_cast<float>(coordinate));
}

// The distance at which a ray meets something; infinite if it goes on free to max_m, NaN if it cannot be
// told.
float rangeAlong(const FloorGrid& grid, const Eigen::Vector2d& from_W, const Eigen::Vector2d& ray,
                 double max_m) {
  for (double range_m = 0.0; range_m <= max_m; range_m += 0.5 * grid.cell_size_m) {
    const int8_t cell = grid.at(from_W + range_m * ray);
    if (cell == kFloorOccupied) return static_cast<float>(range_m);
    if (cell == kFloorUnknown && range_m > grid.cell_size_m) return std::numeric_limits<float>::quiet_NaN();
  }
  return std::numeric_limits<float>::infinity();
}

}  // namespace

sensor_msgs::PointCloud2 makeDistanceCloud(const std_msgs::Header& header, const EsdfGrid& space,
                                           std::optional<double> z_m) {
  const int level = space.cellAt({0.0, 0.0, z_m.value_or(0.0)}).z();
  std::vector<float> values;
  space.forEachCell([&](const Eigen::Vector3i& cell, CellState, float distance_m) {
    if (std::isnan(distance_m) || (z_m && cell.z() != level)) return;
    append(values, space.middleOf(cell));
    values.push_back(distance_m);
  });
  return makeCloud(header, values, true);
}

sensor_msgs::PointCloud2 makeOccupiedCloud(const std_msgs::Header& header, const EsdfGrid& space) {
  std::vector<float> values;
  space.forEachCell([&](const Eigen::Vector3i& cell, CellState state, float) {
    if (state == CellState::kOccupied) append(values, space.middleOf(cell));
  });
  return makeCloud(header, values, false);
}

nav_msgs::OccupancyGrid makeOccupancyGrid(const std_msgs::Header& header, const FloorGrid& grid) {
  nav_msgs::OccupancyGrid message;
  message.header = header;
  message.info.map_load_time = header.stamp;
  message.info.resolution = static_cast<float>(grid.cell_size_m);
  message.info.width = static_cast<uint32_t>(grid.columns);
  message.info.height = static_cast<uint32_t>(grid.rows);
  message.info.origin.position.x = grid.origin_m().x();
  message.info.origin.position.y = grid.origin_m().y();
  message.info.origin.orientation.w = 1.0;
  message.data = grid.cells;
  return message;
}

std::optional<map_msgs::OccupancyGridUpdate> makeGridUpdate(const std_msgs::Header& header,
                                                            const FloorGrid& before, const FloorGrid& now) {
  Eigen::AlignedBox2i changed;
  for (int row = 0; row < now.rows; ++row) {
    for (int column = 0; column < now.columns; ++column) {
      const size_t place = now.place(column, row);
      if (before.cells[place] != now.cells[place]) changed.extend(Eigen::Vector2i(column, row));
    }
  }
  if (changed.isEmpty()) return std::nullopt;
  map_msgs::OccupancyGridUpdate update;
  update.header = header;
  update.x = changed.min().x();
  update.y = changed.min().y();
  update.width = static_cast<uint32_t>(changed.sizes().x() + 1);
  update.height = static_cast<uint32_t>(changed.sizes().y() + 1);
  for (int row = changed.min().y(); row <= changed.max().y(); ++row) {
    for (int column = changed.min().x(); column <= changed.max().x(); ++column)
      update.data.push_back(now.cells[now.place(column, row)]);
  }
  return update;
}

FloorScan scanFloor(const FloorGrid& grid, const Pose& T_W_L, double max_range_m) {
  FloorScan scan;
  scan.max_range_m = max_range_m;
  const Eigen::Vector2d from_W = T_W_L.translation().head<2>();
  for (int beam = 0; beam < FloorScan::kBeams; ++beam) {
    const double angle_rad = -M_PI + beam * kBeam_rad;
    const Eigen::Vector3d ray_L(std::cos(angle_rad), std::sin(angle_rad), 0.0);
    const Eigen::Vector2d ray_W = (T_W_L.linear() * ray_L).head<2>().normalized();
    scan.ranges_m.push_back(rangeAlong(grid, from_W, ray_W, max_range_m));
    if (std::isinf(scan.ranges_m.back())) scan.points.push_back(max_range_m * ray_L.head<2>());
  }
  const Pose T_L_W = T_W_L.inverse();
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      if (grid.cells[grid.place(column, row)] != kFloorOccupied) continue;
      const Eigen::Vector2d p_W =
          grid.cell_size_m * (grid.first + Eigen::Vector2i(column, row)).cast<double>() +
          Eigen::Vector2d::Constant(0.5 * grid.cell_size_m);
      const Eigen::Vector3d p_L = T_L_W * Eigen::Vector3d(p_W.x(), p_W.y(), T_W_L.translation().z());
      if ((p_W - from_W).norm() <= max_range_m) scan.points.emplace_back(p_L.head<2>());
    }
  }
  return scan;
}

sensor_msgs::LaserScan makeLaserScan(const std_msgs::Header& header, const FloorScan& scan) {
  sensor_msgs::LaserScan message;
  message.header = header;
  message.angle_min = static_cast<float>(-M_PI);
  message.angle_increment = static_cast<float>(kBeam_rad);
  message.angle_max = static_cast<float>(M_PI - kBeam_rad);
  message.range_min = 0.0f;
  message.range_max = static_cast<float>(scan.max_range_m);
  message.ranges = scan.ranges_m;
  return message;
}

sensor_msgs::PointCloud2 makeObstacleCloud(const std_msgs::Header& header, const FloorScan& scan) {
  std::vector<float> values;
  for (const Eigen::Vector2d& p_L : scan.points) append(values, {p_L.x(), p_L.y(), 0.0});
  return makeCloud(header, values, false);
}

}  // namespace depth_fusion
