// Resets of the map: nothing of what was before is left, whatever is on its way.
#include <thread>

#include "ros/in_process/frame_admission.h"
#include "ros/in_process/shared_map.h"
#include "support/live_graph.h"

namespace depth_fusion {
namespace {

size_t blocksOf(SharedMap& map) {
  return map.locked([](FusedMap& fused) { return fused.map().slots().used(); });
}

uint32_t generationOf(SharedMap& map) {
  return map.locked([](FusedMap& fused) { return fused.map().generation(); });
}

class Resets : public LiveGraph {
 protected:
  // A map of three frames, and the fourth as tracked in it.
  void mapSomeFrames() {
    loadTracking();
    late_ = graph_.handle().advertise<TrackedFrameMessage>("icp_tracking/frame", 1);
    const std::vector<RgbdFrame> frames = simulatedFrames(smallRoom(4));
    fuseAll({frames.begin(), frames.begin() + 3});
    const Listener<TrackedFrameMessage> tracked(graph_.handle(), "icp_tracking/frame");
    fuseAll({frames.back()});
    frame_ = *tracked.awaitStamp(camera_.headerOf(frames.back()).stamp)->payload;
  }
  // The frame once more, with a stamp of its own, as it is on its way when the map is reset.
  ros::Time send(ros::WallTime received, Beginning begins) {
    auto sensor = std::make_shared<SensorFrame>(*frame_.sensor);
    sensor->header.stamp += ros::Duration(++sent_);
    sensor->received = received;
    auto frame = std::make_shared<TrackedFrame>(frame_);
    frame->sensor = sensor;
    frame->begins = begins;
    late_.publish(makeMessage<TrackedFrame>(sensor->header, frame));
    return sensor->header.stamp;
  }
  void expectRefused(const ros::Time& stamp) {
    const auto status = map_status_.awaitStamp(stamp);
    ASSERT_NE(status, nullptr);
    EXPECT_FALSE(status->fused);
    EXPECT_EQ(status->reason, kBeforeReset);
    EXPECT_EQ(status->blocks, 0u);
  }

  ros::Publisher late_;
  TrackedFrame frame_;
  int sent_ = 0;
};

TEST_F(Resets, EmptyMapAndTracker) {
  Listener<TrackedFrameMessage> tracked(graph_.handle(), "icp_tracking/frame");
  loadTracking();
  const std::vector<RgbdFrame> frames = simulatedFrames(smallRoom(12));
  fuseAll({frames.begin(), frames.begin() + 6});
  const uint32_t before = map_status_.all().back()->generation;
  resetVolume();
  EXPECT_EQ(blocksOf(*findMap(graph_.resolve("tsdf_fusion"))), 0u);
  ros::WallDuration(2.0).sleep();  // until the tracker has heard of it: what comes sooner is from before

  fuseAll({frames.begin() + 6, frames.end()});
  const MapStatus after = *map_status_.all().back();
  EXPECT_NE(after.generation, before);
  EXPECT_EQ(after.frames.processed, 12u);
  // The first frame after it begins a map of its own.
  const auto first = tracked.awaitStamp(camera_.headerOf(frames[6]).stamp);
  EXPECT_TRUE(fromMessage(poses_.awaitStamp(first->header.stamp)->pose.pose).translation().isZero());
}

// A map of two frames, and then another place.
TEST_F(Resets, BeginAMapAnewThatNothingFits) {
  loadTracking();
  fuseAll(simulatedFrames(smallRoom(2)));
  const uint32_t before = map_status_.all().back()->generation;
  const Pose T_W_last = fromMessage(poses_.all().back()->pose.pose);
  SimulationOptions options = smallRoom(30);
  options.scene = "cylinder";
  TrackerStatus::ConstPtr status;
  for (RgbdFrame& frame : simulatedFrames(options)) {
    frame.stamp_s += 1.0;
    status = track(frame);
    ASSERT_NE(status, nullptr);
    if (status->state != TrackerStatus::LOST) break;
  }
  ASSERT_EQ(status->state, TrackerStatus::DEGENERATE) << status->reason;
  EXPECT_EQ(status->guessed_directions, 6);
  EXPECT_NE(status->reason.find("a map begins anew"), std::string::npos) << status->reason;
  const auto of_map = map_status_.awaitStamp(status->header.stamp);
  ASSERT_NE(of_map, nullptr);
  EXPECT_TRUE(of_map->fused) << of_map->reason;
  EXPECT_NE(of_map->generation, before);
  EXPECT_NE(of_map->reason.find("a map begins anew"), std::string::npos) << of_map->reason;
  expectPose(fromMessage(poses_.awaitStamp(status->header.stamp)->pose.pose), T_W_last, 0.3, 0.3);
}

TEST_F(Resets, RefuseFramesFromBefore) {
  mapSomeFrames();
  resetVolume();
  const uint32_t of_old_map = frame_.map_generation;
  const uint32_t of_new_map = generationOf(*findMap(graph_.resolve("tsdf_fusion")));
  ASSERT_NE(of_old_map, of_new_map);
  for (const Beginning begins : {Beginning::kNone, Beginning::kMap, Beginning::kPart}) {
    for (const uint32_t generation : {of_old_map, of_new_map, 0u}) {
      frame_.map_generation = generation;
      expectRefused(send(frame_.sensor->received, begins));
    }
    // Tracked in the map that is gone, or by one who has not heard of it.
    for (const uint32_t generation : {of_old_map, 0u}) {
      frame_.map_generation = generation;
      expectRefused(send(ros::WallTime::now(), begins));
    }
  }
}

// Frames and reset wait for the map at the same time; whoever comes first, nothing is left of the frames.
TEST_F(Resets, LeaveNothingOfFramesThatWaitForTheMap) {
  mapSomeFrames();
  const std::shared_ptr<SharedMap> map = findMap(graph_.resolve("tsdf_fusion"));
  for (int round = 0; round < 5; ++round) {
    frame_.map_generation = generationOf(*map);
    std::thread resetting;
    const ros::Time stamp = map->locked([&](FusedMap&) {
      const ros::Time sent = send(ros::WallTime::now(), Beginning::kMap);
      ros::WallDuration(0.1).sleep();
      resetting = std::thread([this] { resetVolume(); });
      ros::WallDuration(0.1).sleep();
      return sent;
    });
    resetting.join();
    ASSERT_NE(map_status_.awaitStamp(stamp), nullptr);
    EXPECT_EQ(blocksOf(*map), 0u) << round;
  }
}

TEST(MapResets, GoByArrivalAndForAShortTimeByStamps) {
  const MapReset reset{ros::WallTime(100.0), ros::Time(50.0)};
  const auto isBefore = [&](double received_s, double stamp_s) {
    SensorFrame frame;
    frame.received = ros::WallTime(received_s);
    frame.header.stamp = ros::Time(stamp_s);
    return reset.isAfter(frame);
  };
  EXPECT_TRUE(isBefore(99.9, 60.0));
  EXPECT_TRUE(isBefore(100.1, 49.9)) << "was on its way";
  EXPECT_FALSE(isBefore(100.1, 50.1));
  EXPECT_FALSE(isBefore(100.1, 1000.0)) << "stamps of another clock";
  EXPECT_FALSE(isBefore(100.1, 1.0)) << "stamps of another clock";
  EXPECT_FALSE(isBefore(102.0, 49.9)) << "a bag in a loop";
}

// Frames as they come to the map, one after the other.
class Admissions : public testing::Test {
 protected:
  Admission admit(Beginning begins = Beginning::kNone, uint32_t clock_jumps = 0) {
    auto sensor = std::make_shared<SensorFrame>();
    sensor->received = ros::WallTime(100.0);
    sensor->clock_jumps = clock_jumps;
    TrackedFrame frame;
    frame.sensor = sensor;
    frame.map_generation = known_generation_;
    frame.begins = begins;
    return admission_->admit(frame, map_, resets_on_jump_);
  }

  static constexpr uint32_t kFirst = 5;
  std::unique_ptr<FrameAdmission> admission_ = std::make_unique<FrameAdmission>(false, kFirst);
  MapState map_{kFirst, false};
  uint32_t known_generation_ = kFirst;  // to the tracker
  bool resets_on_jump_ = true;
};

TEST_F(Admissions, AreForFramesOfTheMapThatIsThere) {
  EXPECT_TRUE(admit().fuse);
  known_generation_ = kFirst - 1;
  EXPECT_EQ(admit().reason, kBeforeReset);
  known_generation_ = 0;  // has not heard of any map
  EXPECT_FALSE(admit().fuse);
  map_.is_empty = true;
  EXPECT_TRUE(admit().fuse);
  map_.generation = kFirst + 1;  // emptied by a call
  EXPECT_FALSE(admit().fuse);
}

TEST_F(Admissions, EndWithAReset) {
  admission_->noteReset({ros::WallTime(100.5), ros::Time(0)});
  EXPECT_EQ(admit(Beginning::kMap).reason, kBeforeReset);
  admission_->noteReset({ros::WallTime(50.0), ros::Time(0)});
  EXPECT_EQ(admit(Beginning::kMap).begins, Beginning::kMap);
  EXPECT_EQ(admit(Beginning::kPart).begins, Beginning::kPart);
}

TEST_F(Admissions, OfPosesFromElsewhereBeginAMapWhenTheClockJumps) {
  admission_ = std::make_unique<FrameAdmission>(true, kFirst);
  known_generation_ = 0;
  EXPECT_EQ(admit(Beginning::kNone, 0).begins, Beginning::kNone);
  EXPECT_EQ(admit(Beginning::kNone, 1).begins, Beginning::kMap);
  EXPECT_EQ(admit(Beginning::kNone, 1).begins, Beginning::kNone);
  EXPECT_EQ(admit(Beginning::kNone, 0).reason, "from before a clock jump");
  resets_on_jump_ = false;
  EXPECT_TRUE(admit(Beginning::kNone, 2).fuse);
  EXPECT_EQ(admit(Beginning::kNone, 3).begins, Beginning::kNone);
}

TEST_F(Admissions, StandStillInOtherModes) {
  admission_->setMode(MapMode::kPaused);
  EXPECT_EQ(admit().reason, "paused");
  EXPECT_FALSE(admit().may_predict_from);
  admission_->setMode(MapMode::kLocalisation);
  EXPECT_EQ(admit().reason, "localisation only");
  EXPECT_TRUE(admit().may_predict_from);
  EXPECT_FALSE(admit(Beginning::kMap).may_predict_from);
  map_.is_empty = true;
  EXPECT_FALSE(admit().may_predict_from);
}

}  // namespace
}  // namespace depth_fusion
