// Whether a camera delivers colour in time for its depth.
#pragma once

#include "depth_fusion/acquisition/rgbd_device.h"

namespace depth_fusion {

class ColorDelay {
 public:
  // An image of the stream has come, with that stamp.
  void note(ImageStream stream, double stamp_s) {
    if (stream == ImageStream::kDepth) last_depth_s_ = stamp_s;
    if (stream != ImageStream::kColor) return;
    delay_s_ = last_depth_s_ - stamp_s;
    const bool late = delay_s_ > kLate_s;
    in_a_row_ = late == was_late_ ? in_a_row_ + 1 : 1;
    was_late_ = late;
    if (in_a_row_ >= kManyInARow) is_late_ = late;
  }

  // Forgets what was late: the images to come are those of a camera opened anew.
  void restart() {
    in_a_row_ = 0;
    was_late_ = is_late_ = false;
  }

  // How much older the last colour image is than the depth image before it, in seconds.
  double delay_s() const { return delay_s_; }
  // True once many images in a row were late, until many in a row are in time.
  bool isLate() const { return is_late_; }

 private:
  static constexpr double kLate_s = 0.1;  // as long as the nodelets wait for colour
  static constexpr int kManyInARow = 15;

  double last_depth_s_ = 0.0;
  double delay_s_ = 0.0;
  int in_a_row_ = 0;  // as late, or as timely, as the last
  bool was_late_ = false;
  bool is_late_ = false;
};

}  // namespace depth_fusion
