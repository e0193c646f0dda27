// Depth images, and the colour images that belong to them by their stamps.
#pragma once

#include <ros/time.h>

#include <cstdint>
#include <deque>
#include <memory>
#include <string>

#include "recording/unpaired_color.h"
#include "ros/conversions/image_message.h"
#include "ros/input/rgbd_parameters.h"

namespace depth_fusion {

// A depth image with the colour that belongs to it, as they came. They are decoded when their turn comes, and
// never if they are skipped.
struct RgbdMessages {
  std_msgs::Header header;          // the depth image's, with the stamp that it goes on with
  ImageMessage depth, color;        // color is empty if there is none within max_gap_s
  std::string color_problem;        // why there is none though colour comes
  sensor_msgs::ImageConstPtr mask;  // of what is not to be mapped; null: none
  std::string depth_topic, color_topic;
  uint32_t clock_jumps = 0;  // how often the clock had jumped back before
  ros::WallTime received;
};
using RgbdMessagesPtr = std::shared_ptr<const RgbdMessages>;

// Depth images wait here, in the order that they come in, until their colour has come or will not come any
// more. Not thread-safe. `now` is the wall clock's.
class RgbdPairing {
 public:
  explicit RgbdPairing(const PairingParameters& parameters) : parameters_(parameters) {}

  // Counts for the images that wait, too.
  void setParameters(const PairingParameters& parameters) { parameters_ = parameters; }

  // Its time of reception counts from when it waits.
  void addDepth(const std::shared_ptr<RgbdMessages>& depth);
  // Only the latest 30 colour images are kept.
  void addColor(const ros::Time& stamp, const ImageMessage& image);

  // The depth image that waits longest, or null.
  const RgbdMessages* first() const { return waiting_.empty() ? nullptr : waiting_.front().get(); }
  // How long it has waited, in seconds.
  double waited_s(const ros::WallTime& now) const { return (now - first()->received).toSec(); }
  // Its colour is here or will not come. `color_comes`: somebody publishes colour.
  bool firstIsComplete(const ros::WallTime& now, bool color_comes) const;
  // Takes it out, with the colour image that is nearest in time.
  RgbdMessagesPtr takeFirst();

  // The clock was set back to that stamp: forgets the depth images that wait, and colour from a second later
  // on. Returns how many depth images those were.
  size_t restart(const ros::Time& stamp);

 private:
  struct Color {
    ros::Time stamp;
    ImageMessage image;
  };

  PairingParameters parameters_;
  std::deque<std::shared_ptr<RgbdMessages>> waiting_;
  std::deque<Color> colors_;
  bool color_has_come_ = false;  // since a depth image was taken
  UnpairedColor unpaired_;
};

}  // namespace depth_fusion
