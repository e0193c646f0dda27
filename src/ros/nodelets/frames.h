// A frame on its way from nodelet to nodelet.
#pragma once

#include <sensor_msgs/Image.h>

#include <memory>

#include "depth_fusion/icp_tracking/icp_tracker.h"
#include "depth_fusion/texture_odometry/texture_odometry.h"
#include "ros/nodelets/process_message.h"

namespace depth_fusion {

// A depth image with the colour that belongs to it.
struct SensorFrame {
  std_msgs::Header header;  // the depth image's
  RgbdFrame rgbd;           // its pixels may lie in the messages below
  sensor_msgs::ImageConstPtr depth_message, color_message;
  uint32_t clock_jumps = 0;  // backwards, before this frame
};
using SensorFramePtr = std::shared_ptr<const SensorFrame>;

// Topic texture_odometry/frame.
struct TexturedFrame {
  SensorFramePtr sensor;
  TextureOdometryResult motion;  // since the textured frame before
  FrameFeatures features;
};
using TexturedFrameMessage = ProcessMessage<TexturedFrame>;

// Topic icp_tracking/frame.
struct TrackedFrame {
  SensorFramePtr sensor;
  std::shared_ptr<const DepthFrame> depth;  // preprocessed; null if lost
  TrackingResult tracking;
  uint32_t map_generation = 0;              // of the map that it was tracked against; 0: of none
  bool begins_map = false;                  // the clock jumped back: the map is to begin anew with this frame
};
using TrackedFrameMessage = ProcessMessage<TrackedFrame>;

enum class MapMode : uint8_t { kMapping, kLocalisation, kPaused };

// Topic tsdf_fusion/model_view: the answer to each tracked frame, with its stamp, and news of a reset or of another mode.
struct MapView {
  std::shared_ptr<const ModelView> view;  // of the last accepted frame; null if there is nothing to be seen yet
  bool accepted = false;                  // the frame is in the map, or may be predicted from for another reason
  std::string reason;                     // why not
  uint32_t map_generation = 0;            // another one after every reset
  MapMode mode = MapMode::kMapping;
};
// The reason of frames that were taken before the map was emptied; a MapView without a frame has it when that happens.
constexpr char kBeforeReset[] = "from before a reset";
using MapViewMessage = ProcessMessage<MapView>;

}  // namespace depth_fusion
