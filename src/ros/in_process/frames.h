// A frame on its way from nodelet to nodelet.
#pragma once

#include <ros/time.h>
#include <sensor_msgs/Image.h>

#include <cmath>
#include <memory>

#include "depth_fusion/frames/depth_frame.h"
#include "depth_fusion/frames/model_view.h"
#include "depth_fusion/frames/rgbd_frame.h"
#include "depth_fusion/frames/textured_frame.h"
#include "depth_fusion/frames/tracking_result.h"
#include "depth_fusion/texture_odometry/texture_odometry_parameters.h"
#include "ros/in_process/process_message.h"

namespace depth_fusion {

class Corrections;
class SharedMap;

// A depth image with the colour that belongs to it.
struct SensorFrame {
  std_msgs::Header header;  // the depth image's
  RgbdFrame rgbd;           // its pixels may lie in the messages below
  sensor_msgs::ImageConstPtr depth_message, color_message;
  ros::WallTime received = ros::WallTime::now();
  uint32_t clock_jumps = 0;  // how often the clock had jumped back before this frame
};
using SensorFramePtr = std::shared_ptr<const SensorFrame>;

// What travels on the topic texture_odometry/frame.
struct TexturedSensorFrame {
  SensorFramePtr sensor;
  TexturedFrame texture;
  std::shared_ptr<const TextureOdometryParameters>
      parameters;  // of the texture; null without texture odometry
};
using TexturedFramePtr = std::shared_ptr<const TexturedSensorFrame>;
using TexturedFrameMessage = ProcessMessage<TexturedSensorFrame>;

// The frame where there is no texture odometry; null for null.
inline TexturedFramePtr withoutTexture(const SensorFramePtr& sensor) {
  if (sensor == nullptr) return nullptr;
  return std::make_shared<TexturedSensorFrame>(
      TexturedSensorFrame{sensor, withoutTexture("no texture odometry"), nullptr});
}

// What begins with a frame.
enum class Beginning { kNone, kMap, kPart };

// What travels on the topic icp_tracking/frame.
struct TrackedFrame {
  SensorFramePtr sensor;
  std::shared_ptr<const DepthFrame> depth;  // preprocessed; null if lost
  TrackingResult tracking;
  uint32_t map_generation = 0;  // of the map that it was tracked against; 0: of none
  // kMap: the map is emptied before; kPart: nothing says how the frame lies to the map of before.
  Beginning begins = Beginning::kNone;
};
using TrackedFramePtr = std::shared_ptr<const TrackedFrame>;
using TrackedFrameMessage = ProcessMessage<TrackedFrame>;

// When the map was emptied by a call.
struct MapReset {
  ros::WallTime called;
  ros::Time stamp;

  // Whether the frame was taken before the reset. It was if it was received by then. For a short time after,
  // while images from before may still be on their way, it also was if its stamp, of the same clock, says so.
  bool isAfter(const SensorFrame& frame) const {
    constexpr double kOnTheirWay_s = 1.0, kSameClock_s = 10.0;
    if (frame.received < called) return true;
    const double later_s = frame.header.stamp.toSec() - stamp.toSec();
    return (frame.received - called).toSec() < kOnTheirWay_s && later_s <= 0.0 && later_s > -kSameClock_s;
  }
};

enum class MapMode : uint8_t { kMapping, kLocalisation, kPaused };

// Closed loops have moved the map: it is another one, of another generation.
struct MapMove {
  uint32_t from_generation = 0;
  std::shared_ptr<const Corrections> corrections;  // of the poses in the map before
  double moved_m = 0.0;                            // of the keyframe that is moved most
  double jump_m = 0.0;                             // of the last pose
};

// What travels on the topic tsdf_fusion/model_view: the answer to each tracked frame, with its stamp, and
// news of a reset or of another mode.
struct MapView {
  std::shared_ptr<const ModelView>
      view;                     // of the last accepted frame; null if there is nothing to be seen yet
  bool accepted = false;        // the frame is in the map, or may be predicted from for another reason
  std::string reason;           // why not
  uint32_t map_generation = 0;  // another one after every reset
  MapMode mode = MapMode::kMapping;
  MapReset reset;                       // the last one
  std::shared_ptr<const MapMove> move;  // by which this map came from the one before; null if it did not
  std::weak_ptr<SharedMap> map;
};
// The reason of frames that were taken before the map was emptied.
constexpr char kBeforeReset[] = "from before a reset";
using MapViewMessage = ProcessMessage<MapView>;

}  // namespace depth_fusion
