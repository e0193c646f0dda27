// How much may be sent to viewers.
#pragma once

#include <ros/time.h>

#include <algorithm>
#include <cstddef>

namespace depth_fusion {

// A rate of bytes. What is not used is kept for a second; what was sent beyond it is waited for.
class ByteBudget {
 public:
  // The time that has passed since the last call adds to it.
  void refill(double bytes_per_s, const ros::WallTime& now) {
    if (!last_.isZero()) bytes_ += bytes_per_s * (now - last_).toSec();
    bytes_ = std::min(last_.isZero() ? bytes_per_s : bytes_, bytes_per_s);
    last_ = now;
  }
  void spend(size_t bytes) { bytes_ -= static_cast<double>(bytes); }
  // Below 0 if too much was sent.
  double left() const { return bytes_; }

 private:
  ros::WallTime last_;
  double bytes_ = 0.0;
};

}  // namespace depth_fusion
