// Depth images, and the colour images that belong to them by their stamps.
#pragma once

#include <ros/time.h>

#include <deque>
#include <memory>

#include "ros/conversions/image_message.h"
#include "ros/in_process/frames.h"
#include "ros/input/rgbd_parameters.h"

namespace depth_fusion {

// Depth images wait here, in the order that they come in, until their colour has come or will not come any
// more. Not thread-safe. `now` is the wall clock's.
class RgbdPairing {
 public:
  struct Pair {
    std::shared_ptr<SensorFrame> frame;
    ImageMessage color;  // empty if there is none within max_gap_s
  };

  explicit RgbdPairing(const PairingParameters& parameters) : parameters_(parameters) {}

  // Counts for the images that wait, too.
  void setParameters(const PairingParameters& parameters) { parameters_ = parameters; }

  void addDepth(const std::shared_ptr<SensorFrame>& frame, const ros::WallTime& now);
  // Only the latest 30 colour images are kept.
  void addColor(const ros::Time& stamp, const ImageMessage& image);

  // The depth image that waits longest, or null.
  const SensorFrame* first() const { return waiting_.empty() ? nullptr : waiting_.front().frame.get(); }
  // How long it has waited, in seconds.
  double waited_s(const ros::WallTime& now) const { return (now - waiting_.front().since).toSec(); }
  // Its colour is here or will not come. `color_comes`: somebody publishes colour.
  bool firstIsComplete(const ros::WallTime& now, bool color_comes) const;
  // Takes it out, with the colour image that is nearest in time.
  Pair takeFirst();

  // The clock was set back to that stamp: forgets the depth images that wait, and colour from a second later
  // on. Returns how many depth images those were.
  size_t restart(const ros::Time& stamp);

 private:
  struct Waiting {
    std::shared_ptr<SensorFrame> frame;
    ros::WallTime since;
  };
  struct Color {
    ros::Time stamp;
    ImageMessage image;
  };

  PairingParameters parameters_;
  std::deque<Waiting> waiting_;
  std::deque<Color> colors_;
};

}  // namespace depth_fusion
