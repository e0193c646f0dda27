// What the stamps of a sensor's images say about their order and about the clock.
#pragma once

#include <ros/time.h>

#include <cstdint>
#include <optional>
#include <string>

namespace depth_fusion {

// The stamp itself or, of an image that has none, the time of its arrival.
ros::Time stampOrArrival(const ros::Time& stamp, const ros::Time& arrival);

// An image is to be later than the one before it, and by about as much as it came later. One that is off by
// more, into the past or the future, is believed if ROS time says the same, or once several in a row agree: a
// single image may carry a wrong stamp, of USB's or a driver's making. Stamps that stand still are none:
// arrival counts instead. Not thread-safe.
class StampPolicy {
 public:
  enum class Order {
    kNext,        // the image is later than the one before it
    kOutOfOrder,  // it is not, by less than a second: it is not to be used
    kDoubtful,    // its stamp is far off, and alone so far: it is not to be used
    kClockJump,   // the clock was set back, by a second or more: time begins anew with it
  };
  struct Verdict {
    Order order = Order::kNext;
    ros::Time stamp;           // that the image goes on with
    double off_s = 0.0;        // how much later than the image before it, if it is doubtful or a jump
    std::string reason;        // why a jump is believed
    uint32_t clock_jumps = 0;  // so far, this one included
  };

  // Judges the image that arrives next, at that ROS time. Images that are not to be used change nothing for
  // those after them but that they may agree.
  Verdict judge(const ros::Time& stamp, const ros::Time& arrival);

 private:
  struct Image {
    ros::Time stamp, arrival;
  };
  // Doubtful images that agree with each other, up to the last one.
  struct Doubtful {
    Image last;
    int in_a_row = 0;
  };

  Verdict judgeAfter(const Image& before, const Image& image);
  ros::Time usedStamp(const ros::Time& stamp, const ros::Time& arrival);
  // Whether this one, too, agrees with those before; begins anew with it if it does not.
  bool areMany(const Image& image);

  std::optional<Image> last_;  // that was used
  Doubtful doubtful_;
  ros::Time same_;  // the stamp as it came last
  int same_in_a_row_ = 0;
  uint32_t clock_jumps_ = 0;
};

}  // namespace depth_fusion
