// The time of images whose stamps jump.
#pragma once

#include <optional>

namespace depth_fusion {

// Where a camera's clock jumps ahead, is set back or stands still, the time that passed between the receipts
// of its images says how far, and what follows is moved by that: times go on as if nothing had been. All in
// seconds.
class BagClock {
 public:
  // lead_s: by how much stamps are usually ahead of the receipt.
  explicit BagClock(double lead_s) : lead_s_(lead_s) {}

  // The time of the next image, which is later than that of the one before. Nothing for an image that is a
  // little behind the one before it: it comes out of order. If the next is behind as well, the clock was set
  // back.
  std::optional<double> timeOf(double stamp_s, double received_s);

 private:
  std::optional<double> timeByStamp(double stamp_s, double received_s) const;
  double timeByReceipt(double received_s) const;
  bool isLittleBehind(double stamp_s) const;

  double lead_s_;
  double shift_s_ = 0.0;  // from stamps to times, since the last jump
  std::optional<double> last_stamp_s_, last_time_s_;
  bool was_behind_ = false;  // the last image was left out
};

}  // namespace depth_fusion
