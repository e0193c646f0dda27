#include "ros/input/rgbd_decoder.h"

#include <ros/console.h>

#include "depth_fusion/frames/y_down.h"

namespace depth_fusion {
namespace {

SensorFrame withDepth(const RgbdMessages& messages) {
  SensorFrame frame;
  frame.header = messages.header;
  frame.clock_jumps = messages.clock_jumps;
  frame.received = messages.received;
  frame.rgbd.stamp_s = messages.header.stamp.toSec();
  const DepthImage depth = toDepth(messages.depth, messages.depth_topic);
  frame.rgbd.depth = depth.image;
  frame.rgbd.depth_unit_m = depth.unit_m;
  if (depth.is_in_unusual_unit)
    ROS_WARN_STREAM_ONCE(messages.depth_topic
                         << ": the numbers are too large for metres and taken for millimetres");
  frame.depth_message = messages.depth.raw;
  return frame;
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

void leaveUnusableColorOut(RgbdFrame& frame) {
  frame.color_problem = presentColorProblem(frame);
  if (!frame.color_problem.empty()) frame.color.release();
}

}  // namespace

SensorFramePtr RgbdDecoder::decode(const RgbdMessages& messages, const RegistrationParameters& registration) {
  auto frame = std::make_shared<SensorFrame>(withDepth(messages));
  addColor(messages, *frame);
  const std::string color_frame = cameras_.describe(messages, *frame);
  makeYDown(frame->rgbd);
  leaveUnusableColorOut(frame->rgbd);
  frame->rgbd = registration_.process(frame->rgbd, registration);
  const bool moved_to_color = !color_frame.empty() && !frame->rgbd.T_C_D;
  if (moved_to_color) frame->header.frame_id = color_frame;
  return frame;
}

}  // namespace depth_fusion
