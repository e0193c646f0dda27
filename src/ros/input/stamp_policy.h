// What the stamps of a sensor's images say about their order and about the clock.
#pragma once

#include <ros/time.h>

#include <cstdint>
#include <optional>

namespace depth_fusion {

// The stamp itself or, of an image that has none, the time of its arrival.
ros::Time stampOrArrival(const ros::Time& stamp, const ros::Time& arrival);

class StampPolicy {
 public:
  enum class Order {
    kNext,        // the image is later than the one before it
    kOutOfOrder,  // it is not, by less than a second: it is not to be used
    kClockJump,   // it is earlier by a second or more: the clock was set back, and time begins anew with it
  };
  struct Verdict {
    Order order = Order::kNext;
    ros::Time stamp;           // that the image goes on with
    double back_s = 0.0;       // how much earlier than the image before it; 0 for kNext
    uint32_t clock_jumps = 0;  // so far, this one included
  };

  // Judges the image that arrives next. Images out of order leave no trace.
  Verdict judge(const ros::Time& stamp, const ros::Time& arrival);

 private:
  std::optional<ros::Time> last_;
  uint32_t clock_jumps_ = 0;
};

}  // namespace depth_fusion
