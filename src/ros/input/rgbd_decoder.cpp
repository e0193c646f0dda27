#include "ros/input/rgbd_decoder.h"

#include <ros/console.h>
#include <sensor_msgs/image_encodings.h>

#include "depth_fusion/common/error.h"
#include "depth_fusion/frames/y_down.h"
#include "depth_fusion/masking/image_mask.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

using sensor_msgs::image_encodings::bitDepth;
using sensor_msgs::image_encodings::numChannels;

SensorFrame frameOf(const RgbdMessages& messages) {
  SensorFrame frame;
  frame.header = messages.header;
  frame.clock_jumps = messages.clock_jumps;
  frame.received = messages.received;
  frame.rgbd.stamp_s = messages.header.stamp.toSec();
  return frame;
}

void addDepth(const RgbdMessages& messages, SensorFrame& frame) {
  const DepthImage depth = toDepth(messages.depth, messages.depth_topic);
  frame.rgbd.depth = depth.image;
  frame.rgbd.depth_unit_m = depth.unit_m;
  if (depth.is_in_unusual_unit)
    ROS_WARN_STREAM_ONCE(messages.depth_topic
                         << ": the numbers are too large for metres and taken for millimetres");
  frame.depth_message = messages.depth.raw;
}

void addColor(const RgbdMessages& messages, SensorFrame& frame) {
  frame.rgbd.color_problem = messages.color_problem;
  if (messages.color.empty()) return;
  try {
    frame.rgbd.color = toColor(messages.color, messages.color_topic);
    frame.color_message = messages.color.raw;
  } catch (const std::exception& error) {
    frame.rgbd.color_problem = error.what();
  }
}

// The mask is of the colour camera's images if its frame is that camera's. `color_frame` is empty where depth
// is registered to colour.
void leaveMaskedOut(const sensor_msgs::ImageConstPtr& mask, const std::string& color_frame,
                    SensorFrame& frame) {
  if (mask == nullptr) return;
  check(bitDepth(mask->encoding) == 8 && numChannels(mask->encoding) == 1,
        "a mask is " + mask->encoding + "; it must be mono8");
  const std::string mask_frame = withoutSlash(mask->header.frame_id);
  const bool is_of_color = !color_frame.empty() && mask_frame == color_frame;
  check(is_of_color || mask_frame.empty() || mask_frame == frame.header.frame_id,
        "a mask is in the frame " + mask_frame + ", which is neither that of depth (" +
            frame.header.frame_id +
            ") nor that of colour; its header must be that of the image that it was made of");
  applyMask(frame.rgbd, colorFromImage(*mask, "mask"), is_of_color ? MaskView::kColor : MaskView::kDepth);
}

void leaveUnusableColorOut(RgbdFrame& frame) {
  frame.color_problem = presentColorProblem(frame);
  if (!frame.color_problem.empty()) frame.color.release();
}

}  // namespace

void RgbdDecoder::takeCloud(const RgbdMessages& messages, SensorFrame& frame) {
  const sensor_msgs::PointCloud2& cloud = *messages.depth.cloud;
  const std::string& topic = messages.depth_topic;
  if (isOrganised(cloud)) {
    if (!isCameraOf(cloud_camera_, cloud, topic)) cloud_camera_ = cameraOfCloud(cloud, topic);
    frame.rgbd.intrinsics = cloud_camera_;
    frame.rgbd.depth = depthOfCloud(cloud, topic);
    frame.rgbd.color = colorOfCloud(cloud);
  } else {
    frame.rgbd.intrinsics = cameras_.depthCamera(messages.depth.header().stamp);
    frame.rgbd.depth = depthOfPoints(cloud, frame.rgbd.intrinsics, topic);
  }
}

SensorFramePtr RgbdDecoder::decode(const RgbdMessages& messages, const RegistrationParameters& registration) {
  const auto frame = std::make_shared<SensorFrame>(frameOf(messages));
  std::string color_frame;
  if (messages.depth.cloud != nullptr) {
    takeCloud(messages, *frame);
  } else {
    addDepth(messages, *frame);
    addColor(messages, *frame);
    color_frame = cameras_.describe(messages, *frame);
  }
  leaveMaskedOut(messages.mask, color_frame, *frame);
  makeYDown(frame->rgbd);
  leaveUnusableColorOut(frame->rgbd);
  frame->rgbd = registration_.process(frame->rgbd, registration);
  const bool moved_to_color = !color_frame.empty() && !frame->rgbd.T_C_D;
  if (moved_to_color) frame->header.frame_id = color_frame;
  return frame;
}

}  // namespace depth_fusion
