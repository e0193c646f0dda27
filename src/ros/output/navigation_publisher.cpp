#include "ros/output/navigation_publisher.h"

#include "ros/conversions/messages.h"
#include "ros/conversions/navigation_messages.h"

namespace depth_fusion {
namespace {

// How old the latched map may be, for whoever takes no updates.
constexpr double kMapPeriod_s = 2.0;

}  // namespace

NavigationPublisher::NavigationPublisher(ros::NodeHandle& handle) {
  const auto note_viewer = [this](const ros::SingleSubscriberPublisher&) { is_late_ = true; };
  slice_ = handle.advertise<sensor_msgs::PointCloud2>("esdf_slice", 1, note_viewer);
  distances_ = handle.advertise<sensor_msgs::PointCloud2>("esdf_pointcloud", 1, note_viewer);
  centres_ = handle.advertise<sensor_msgs::PointCloud2>("octomap_point_cloud_centers", 1, note_viewer);
  map_ = handle.advertise<nav_msgs::OccupancyGrid>("map", 1, note_viewer, ros::SubscriberStatusCallback(),
                                                   ros::VoidConstPtr(), true);
  updates_ = handle.advertise<map_msgs::OccupancyGridUpdate>("map_updates", 10, note_viewer);
  scan_ = handle.advertise<sensor_msgs::LaserScan>("scan", 1);
  obstacles_ = handle.advertise<sensor_msgs::PointCloud2>("obstacles", 1);
}

uint32_t NavigationPublisher::viewers() const {
  uint32_t viewers = 0;
  for (const ros::Publisher* topic : {&slice_, &distances_, &centres_, &map_, &updates_, &scan_, &obstacles_})
    viewers += topic->getNumSubscribers();
  return viewers;
}

void NavigationPublisher::update(const EsdfGrid& space, bool has_changed, const std::string& frame_id,
                                 const std::optional<Pose>& T_W_L, const NavigationParameters& parameters,
                                 StageTimers& timers) {
  const StageTimers::Scope timer(timers, "navigation/publish");
  const std_msgs::Header header = makeHeader(ros::Time::now(), frame_id);
  const bool is_late = is_late_.exchange(false);
  if (has_changed || is_late) {
    if (slice_.getNumSubscribers() > 0)
      slice_.publish(makeDistanceCloud(header, space, parameters.slice_z_m));
    if (distances_.getNumSubscribers() > 0) distances_.publish(makeDistanceCloud(header, space));
    if (centres_.getNumSubscribers() > 0) centres_.publish(makeOccupiedCloud(header, space));
  }
  const bool is_seen = map_.getNumSubscribers() + updates_.getNumSubscribers() > 0;
  if (!(is_seen && (has_changed || is_late || map_is_old_)) && !T_W_L) return;
  const FloorGrid grid = floorGridOf(space, parameters.grid);
  if (is_seen) publishGrid(grid, header, is_late);
  if (T_W_L) publishScan(grid, *T_W_L, parameters);
}

void NavigationPublisher::publishGrid(const FloorGrid& grid, const std_msgs::Header& header, bool is_late) {
  const bool is_alike = grid.isAlike(grid_);
  const std::optional<map_msgs::OccupancyGridUpdate> update =
      is_alike ? makeGridUpdate(header, grid_, grid) : std::nullopt;
  if (update) updates_.publish(*update);
  map_is_old_ = map_is_old_ || update;
  grid_ = grid;
  const bool is_due = map_is_old_ && (ros::WallTime::now() - last_map_).toSec() > kMapPeriod_s;
  if (is_alike && !is_late && !is_due) return;
  map_.publish(makeOccupancyGrid(header, grid));
  last_map_ = ros::WallTime::now();
  map_is_old_ = false;
}

void NavigationPublisher::publishScan(const FloorGrid& grid, const Pose& T_W_L,
                                      const NavigationParameters& parameters) {
  const std_msgs::Header header = makeHeader(ros::Time::now(), parameters.scan_frame);
  const FloorScan scan = scanFloor(grid, T_W_L, parameters.scan_range_m);
  if (scan_.getNumSubscribers() > 0) scan_.publish(makeLaserScan(header, scan));
  if (obstacles_.getNumSubscribers() > 0) obstacles_.publish(makeObstacleCloud(header, scan));
}

}  // namespace depth_fusion
