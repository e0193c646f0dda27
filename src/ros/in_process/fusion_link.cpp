#include "ros/in_process/fusion_link.h"

#include <chrono>
#include <utility>

namespace depth_fusion {
namespace {

constexpr size_t kMaxViews = 8;
constexpr auto kPeriod = std::chrono::milliseconds(200);
constexpr auto kPatience = std::chrono::milliseconds(60000);  // kernels may have to be built first
constexpr auto kGreeting =
    std::chrono::milliseconds(2000);  // it is on its way as soon as the two are connected

}  // namespace

void FusionLink::receive(const MapViewMessage::ConstPtr& view) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    views_.push_back(view);
    if (views_.size() > kMaxViews)
      views_.pop_front();  // nobody sends frames, and fusion has them from elsewhere
  }
  changed_.notify_all();
}

void FusionLink::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
}

std::vector<FusionNews> FusionLink::await() {
  const auto give_up = std::chrono::steady_clock::now() + (sent_ ? kPatience : kGreeting);
  std::vector<FusionNews> news;
  std::unique_lock<std::mutex> lock(mutex_);
  do {
    for (; !views_.empty(); views_.pop_front()) {
      if (const std::optional<FusionNews> one = newsOf(*views_.front())) news.push_back(*one);
    }
    if (!isWaiting() || !connected()) break;
    changed_.wait_for(lock, kPeriod, [this] { return stopping_ || !views_.empty(); });
  } while (!stopping_ && std::chrono::steady_clock::now() < give_up);
  if (sent_) news.push_back({stopping_ ? FusionNews::kRejected : FusionNews::kUnanswered, nullptr});
  sent_.reset();
  return news;
}

std::optional<FusionNews> FusionLink::newsOf(const MapViewMessage& message) {
  const MapView& view = *message.payload;
  const bool answers = sent_ && message.header.stamp == sent_->stamp;
  const bool accepted = answers && view.accepted;
  mode_ = view.mode;
  reset_ = view.reset;
  const bool other_map = view.map_generation != std::exchange(map_generation_, view.map_generation);
  FusionNews news{FusionNews::kRejected, message.payload};
  if (accepted) {
    news.kind = FusionNews::kAccepted;
  } else if (other_map || (answers && sent_->begins != Beginning::kNone)) {
    news.kind = FusionNews::kOtherMap;
  } else if (!answers) {
    return std::nullopt;
  }
  sent_.reset();
  return news;
}

void FusionLink::send(const SensorFramePtr& frame, std::shared_ptr<const DepthFrame> depth,
                      const TrackingResult& tracking) {
  sent_ = Sent{frame->header.stamp, std::exchange(begins_, Beginning::kNone)};
  frames_.publish(makeMessage<TrackedFrame>(
      frame->header, std::make_shared<TrackedFrame>(
                         TrackedFrame{frame, std::move(depth), tracking, map_generation_, sent_->begins})));
}

}  // namespace depth_fusion
