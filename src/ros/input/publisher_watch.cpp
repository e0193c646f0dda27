#include "ros/input/publisher_watch.h"

#include <algorithm>

namespace depth_fusion {
namespace {

constexpr double kGone_s = 1.0;
// Larger steps are none of messages that were dropped, but of a publisher that numbers by rules of its own.
constexpr uint32_t kMaxMissed = 1000;
// The majority of this many steps decides what is usual.
constexpr int kManySteps = 10;

}  // namespace

PublisherWatch::Verdict PublisherWatch::judge(const std::string& publisher, uint32_t seq, uint32_t publishers,
                                              const ros::WallTime& now) {
  const bool is_first = publisher_.empty();
  const bool is_same = publisher == publisher_;
  if (!is_first && !is_same && publishers > 1 && (now - last_).toSec() < kGone_s) {
    other_ = publisher;
    return {};
  }
  if (publishers < 2) other_.clear();
  const uint32_t step = is_same && seq > seq_ ? seq - seq_ : 1;
  const bool is_loss = single_steps_ > 1 && step - 1 < kMaxMissed;
  if (is_same) single_steps_ = std::clamp(single_steps_ + (step == 1 ? 1 : -1), 0, kManySteps);
  publisher_ = publisher;
  seq_ = seq;
  last_ = now;
  return {true, is_loss ? step - 1 : 0};
}

}  // namespace depth_fusion
