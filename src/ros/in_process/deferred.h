// A frame that waits for its turn.
#pragma once

#include <functional>
#include <memory>
#include <utility>

namespace depth_fusion {

// The frame is there, or it is decoded when its turn comes.
template <class Frame>
class Deferred {
 public:
  using Ptr = std::shared_ptr<const Frame>;

  Deferred(Ptr frame) : frame_(std::move(frame)) {}
  explicit Deferred(std::function<Ptr()> decode) : decode_(std::move(decode)) {}

  // Null if it turns out to be of no use.
  Ptr take() const { return decode_ ? decode_() : frame_; }
  // Null if it is not decoded.
  const Ptr& ready() const { return frame_; }

 private:
  Ptr frame_;
  std::function<Ptr()> decode_;
};

}  // namespace depth_fusion
