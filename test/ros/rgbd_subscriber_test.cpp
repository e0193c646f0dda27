// Frames come one at a time and in order, and nobody but the next frame waits for the one at work.
#include "ros/input/rgbd_subscriber.h"

#include <atomic>
#include <future>

#include "ros/input/published_topics.h"
#include "support/nodelet_graph.h"

namespace depth_fusion {
namespace {

// Long for whatever does not wait, and still short.
constexpr std::chrono::seconds kLong(5);

class RgbdSubscriberTest : public testing::Test {
 protected:
  RgbdSubscriberTest()
      : graph_(std::string("rgbd_") + testing::UnitTest::GetInstance()->current_test_info()->name()),
        frames_(simulatedFrames(smallRoom(6))),
        camera_(graph_.handle()) {}

  void subscribe(const RgbdSubscriber::Callback& callback) {
    RgbdParameters parameters;
    parameters.pairing.max_wait_s = 10.0f;  // colour comes, however slow the machine is
    subscriber_ = std::make_unique<RgbdSubscriber>(graph_.handle(), parameters, "", counter_, callback);
    ASSERT_TRUE(camera_.awaitSubscribers());
  }

  uint64_t droppedFor(const std::string& reason) const {
    const FrameAccount account = counter_.account();
    for (size_t i = 0; i < account.reasons.size(); ++i) {
      if (account.reasons[i] == reason) return account.dropped[i];
    }
    return 0;
  }

  NodeletGraph graph_;
  std::vector<RgbdFrame> frames_;
  FakeCamera camera_;
  FrameCounter counter_;
  std::unique_ptr<RgbdSubscriber> subscriber_;
};

TEST_F(RgbdSubscriberTest, FramesComeOneAtATimeInOrderEachWithItsColour) {
  std::mutex mutex;
  std::vector<RgbdMessagesPtr> received;
  std::atomic<int> at_work{0};
  subscribe([&](const RgbdMessagesPtr& frame) {
    EXPECT_EQ(++at_work, 1);
    ros::WallDuration(0.03).sleep();  // meanwhile the next images, and the timer, come in
    --at_work;
    const std::lock_guard<std::mutex> lock(mutex);
    received.push_back(frame);
  });
  for (const RgbdFrame& frame : frames_) camera_.publish(frame);
  camera_.publishDepth(frames_[2]);  // out of order
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard<std::mutex> lock(mutex);
    return received.size() == frames_.size();
  }));
  EXPECT_TRUE(eventually([&] { return droppedFor("out of order") == 1; }));
  subscriber_.reset();
  ASSERT_EQ(received.size(), frames_.size());
  for (size_t i = 0; i < frames_.size(); ++i) {
    EXPECT_EQ(received[i]->header.stamp, toRosTime(frames_[i].stamp_s)) << i;
    EXPECT_EQ(cv::norm(toColor(received[i]->color, "rgb"), frames_[i].color, cv::NORM_INF), 0.0) << i;
  }
  EXPECT_EQ(counter_.account().received, frames_.size() + 1);
}

// A driver that has just begun may have told the master of the compressed topic only.
TEST_F(RgbdSubscriberTest, ACompressedTopicIsTakenIfTheRawOneDoesNotFollow) {
  ImageTopic topic(graph_.handle(), "other/image", kAutoTransport, ownDepthTransports(),
                   {[](const ImageMessage&) {}, [](uint32_t) {}, [] {}});
  const std::string raw = graph_.resolve("other/image"), compressed = raw + "/compressedDepth";
  const auto look = [&](const std::vector<std::string>& names) {
    ros::master::V_TopicInfo published;
    for (const std::string& name : names) published.emplace_back(name, "");
    topic.lookAround(PublishedTopics(published));
    return topic.name();
  };
  EXPECT_EQ(look({compressed}), raw);
  EXPECT_EQ(look({raw, compressed}), raw);
  EXPECT_EQ(look({compressed}), raw);
  EXPECT_EQ(look({raw + "/compressed"}), raw);
  EXPECT_EQ(look({compressed}), raw);
  EXPECT_EQ(look({compressed}), compressed);
  EXPECT_EQ(look({}), compressed);
  EXPECT_EQ(look({raw, compressed}), compressed) << "once more, as it may only be about to go";
  EXPECT_EQ(look({raw, compressed}), raw) << "it has no publisher, the other one is there";
}

TEST_F(RgbdSubscriberTest, NobodyWaitsForAFrameAtWork) {
  std::promise<void> begun, finish;
  std::atomic<int> frames{0};
  subscribe([&](const RgbdMessagesPtr&) {
    if (frames++ > 0) return;
    begun.set_value();
    finish.get_future().wait();
  });
  camera_.publishDepth(frames_[0]);
  EXPECT_TRUE(eventually([&] { return counter_.account().received == 1; }));
  ros::WallDuration(0.2).sleep();    // the depth waits for its colour
  camera_.publishColor(frames_[1]);  // whose thread delivers the first frame, and the depth's is free
  begun.get_future().wait();
  camera_.publishDepth(frames_[1]);
  const auto asked = std::async(std::launch::async, [&] {
    subscriber_->setParameters(RgbdParameters());
    return subscriber_->problem();
  });
  EXPECT_EQ(asked.wait_for(kLong), std::future_status::ready);
  EXPECT_TRUE(eventually([&] { return counter_.account().received == 2; }));
  ros::WallDuration(0.2).sleep();
  EXPECT_EQ(frames, 1) << "frames come one at a time";
  finish.set_value();
  EXPECT_TRUE(eventually([&] { return frames == 2; }));
}

TEST_F(RgbdSubscriberTest, ItsEndWaitsForTheFrameAtWork) {
  std::promise<void> begun;
  std::atomic<bool> is_done{false};
  std::atomic<int> frames{0};
  subscribe([&](const RgbdMessagesPtr&) {
    if (frames++ == 0) begun.set_value();
    ros::WallDuration(0.3).sleep();
    is_done = true;
  });
  camera_.publish(frames_[0]);
  begun.get_future().wait();
  subscriber_.reset();
  EXPECT_TRUE(is_done);
  camera_.publish(frames_[1]);
  ros::WallDuration(0.3).sleep();
  EXPECT_EQ(frames, 1);
}

// The frame, with that stamp.
RgbdFrame at(RgbdFrame frame, double stamp_s) {
  frame.stamp_s = toRosTime(stamp_s).toSec();
  return frame;
}

TEST_F(RgbdSubscriberTest, AClockSetBackIsBelievedOfManyImagesAndCountedInEveryFrameAfterIt) {
  std::mutex mutex;
  std::vector<uint32_t> clock_jumps;
  subscribe([&](const RgbdMessagesPtr& frame) {
    const std::lock_guard<std::mutex> lock(mutex);
    clock_jumps.push_back(frame->clock_jumps);
  });
  uint64_t sent = 0;
  const auto publish = [&](double stamp_s) {
    camera_.publish(at(frames_[0], stamp_s));
    ++sent;
    EXPECT_TRUE(eventually([&] { return counter_.account().received == sent; }));
  };
  publish(100.0);
  publish(60.0);  // one wrong stamp
  publish(100.1);
  for (int i = 0; i < 6; ++i) publish(50.0 + 0.1 * i);
  EXPECT_TRUE(eventually([&] {
    const std::lock_guard<std::mutex> lock(mutex);
    return clock_jumps.size() == 4;
  }));
  EXPECT_EQ(clock_jumps, (std::vector<uint32_t>{0, 0, 1, 1}));
  EXPECT_EQ(droppedFor("doubtful stamp"), 5u);
}

TEST_F(RgbdSubscriberTest, WhatIsSkippedIsNotDecodedAndWhatCannotBeDecodedIsCounted) {
  std::vector<RgbdMessagesPtr> waiting;
  subscribe([&](const RgbdMessagesPtr& frame) { waiting.push_back(frame); });
  RgbdFrame other_size = frames_[1];
  other_size.intrinsics.width *= 2;
  camera_.publish(frames_[0]);
  EXPECT_TRUE(eventually([&] { return waiting.size() == 1; }));
  camera_.publish(other_size);
  EXPECT_TRUE(eventually([&] { return waiting.size() == 2; }));
  EXPECT_TRUE(counter_.account().dropped.empty()) << "nobody has asked for them yet";
  EXPECT_NE(subscriber_->decode(*waiting[0]), nullptr) << "by the camera_info of its own stamp";
  EXPECT_EQ(subscriber_->decode(*waiting[1]), nullptr);
  EXPECT_EQ(droppedFor("unusable image or camera_info"), 1u);
}

TEST_F(RgbdSubscriberTest, ColourOfAnotherClockIsSaidAndCostsNoDepth) {
  std::vector<RgbdMessagesPtr> waiting;
  subscribe([&](const RgbdMessagesPtr& frame) { waiting.push_back(frame); });
  for (size_t i = 0; i < frames_.size(); ++i) {
    camera_.publishColor(at(frames_[i], frames_[i].stamp_s + 0.5));  // not so late that depth waits for it
    camera_.publishDepth(frames_[i]);
    EXPECT_TRUE(eventually([&] { return waiting.size() == i + 1; }));
  }
  const SensorFramePtr frame = subscriber_->decode(*waiting.back());
  ASSERT_NE(frame, nullptr);
  EXPECT_TRUE(frame->rgbd.color.empty());
  EXPECT_NE(frame->rgbd.color_problem.find("s later"), std::string::npos) << frame->rgbd.color_problem;
  EXPECT_EQ(subscriber_->problem(), frame->rgbd.color_problem);
}

TEST_F(RgbdSubscriberTest, UnusableColourCostsNoDepth) {
  std::vector<RgbdMessagesPtr> waiting;
  subscribe([&](const RgbdMessagesPtr& frame) { waiting.push_back(frame); });
  RgbdFrame odd = frames_[0];
  odd.color_intrinsics = odd.intrinsics;
  odd.color_intrinsics->width /= 2;
  camera_.publish(odd);
  EXPECT_TRUE(eventually([&] { return waiting.size() == 1; }));
  const SensorFramePtr frame = subscriber_->decode(*waiting[0]);
  ASSERT_NE(frame, nullptr);
  EXPECT_TRUE(frame->rgbd.color.empty());
  EXPECT_NE(frame->rgbd.color_problem, "");
  EXPECT_EQ(subscriber_->problem(), frame->rgbd.color_problem);
}

}  // namespace
}  // namespace depth_fusion
