// The conductor of tracking alone: the test says which frames are fused.
#include "depth_fusion/pipeline/tracking_session.h"

#include <gtest/gtest.h>

#include <utility>

#include "depth_fusion/pipeline/mapper.h"
#include "support/expect_error.h"
#include "support/room_frames.h"
#include "support/test_compute.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kCamera{320, 240, 262.5, 262.5, 159.5, 119.5};
constexpr int kFrames = 8;
constexpr int kNotFused = 4;

// Every fused frame is a keyframe, and the sensor's velocity changes the depth.
PipelineParameters sessionParameters() {
  PipelineParameters parameters = coarseRoomParameters();
  parameters.relocalisation.keyframe_distance_m = 0.001f;
  parameters.relocalisation.keyframe_angle_rad = 0.001f;
  parameters.preprocessing.readout_s = 0.03f;
  return parameters;
}

const std::vector<RgbdFrame>& roomFrames() {
  static const std::vector<RgbdFrame> frames = simulateRoom(kCamera, kFrames);
  return frames;
}

// A session with the map that its frames are fused into.
class FusedRoom {
 public:
  explicit FusedRoom(bool with_texture, const PipelineParameters& parameters = sessionParameters())
      : with_texture_(with_texture),
        parameters_(parameters),
        map_(compute(), parameters_.map),
        submaps_(map_, {}),
        mapper_(compute(), map_, submaps_, parameters_, kCamera),
        session_(compute(), parameters_, kCamera,
                 [this](const Pose& T_W_D) -> const ModelView& { return mapper_.render(T_W_D, timers_); }) {
    TextureOdometry odometry(parameters_.texture_odometry, parameters_.depth_sensor);
    for (const RgbdFrame& frame : roomFrames())
      textures_.push_back(with_texture ? odometry.texture(frame, timers_) : withoutTexture("switched off"));
  }

  TrackingResult step(int i, const Pose& start = Pose::Identity()) { return step(i, roomFrames()[i], start); }
  // The frame with other depth.
  TrackingResult step(int i, const RgbdFrame& frame, const Pose& start = Pose::Identity()) {
    return session_.step(frame, textures_[i], view_, timers_, start);
  }
  void prepareAhead(int i) { session_.prepareAhead(roomFrames()[i], textures_[i], timers_); }
  void fuse(int i, const Pose& T_W_D) {
    ASSERT_TRUE(mapper_.fuse(roomFrames()[i], *session_.depth(), T_W_D, false, timers_).fusion.fused());
    view_ = &mapper_.render(T_W_D, timers_);
  }
  // Tracks all frames and fuses all but one.
  std::vector<TrackingResult> trackAll(bool overlapped) {
    std::vector<TrackingResult> results;
    for (int i = 0; i < kFrames; ++i) {
      results.push_back(step(i));
      EXPECT_EQ(results.back().status, TrackingStatus::kTracking) << i << " " << results.back().reason;
      if (overlapped && i + 1 < kFrames) prepareAhead(i + 1);
      if (i != kNotFused) fuse(i, results.back().T_W_D);
      const size_t keyframes = session_.keyframes().size();
      session_.conclude(i != kNotFused);
      const bool becomes_keyframe = with_texture_ && i != kNotFused;
      EXPECT_EQ(session_.keyframes().size(), keyframes + (becomes_keyframe ? 1 : 0)) << i;
    }
    return results;
  }

  // Has the frame's texture say, for certain, that the sensor moved on by so much more.
  void mislead(int i, const Pose& error) {
    FrameMotion& motion = textures_[i].motion;
    motion.T_previous_current = motion.T_previous_current * error;
    motion.covariance = 1e-6 * Matrix6d::Identity();
  }

  TrackingSession& session() { return session_; }
  // What the map shows; null: nothing.
  const ModelView*& view() { return view_; }

 private:
  const bool with_texture_;
  PipelineParameters parameters_;
  StageTimers timers_;
  BlockMap map_;
  SubmapCollection submaps_;
  Mapper mapper_;
  TrackingSession session_;
  std::vector<TexturedFrame> textures_;
  const ModelView* view_ = nullptr;
};

class TrackingSessionTest : public testing::TestWithParam<bool> {
 protected:
  FusedRoom room_{GetParam()};
};

TEST_P(TrackingSessionTest, AFrameThatIsNotFusedIsForgottenAlsoWhereTheNextWasPreparedAhead) {
  const std::vector<TrackingResult> sequential = room_.trackAll(false);
  const std::vector<TrackingResult> overlapped = FusedRoom(GetParam()).trackAll(true);
  for (int i = 0; i < kFrames; ++i) {
    EXPECT_TRUE(sequential[i].T_W_D.matrix() == overlapped[i].T_W_D.matrix()) << i;
    EXPECT_TRUE(sequential[i].covariance == overlapped[i].covariance) << i;
    EXPECT_EQ(sequential[i].prior, overlapped[i].prior) << i;
    EXPECT_EQ(sequential[i].prior, i == 0 ? "start" : GetParam() ? "texture" : "last pose");
  }
}

// The pose is a metre off, so that the next frame is found only if it is not predicted from there.
TEST_P(TrackingSessionTest, TheNextFrameIsPredictedAsIfTheOneNotFusedHadNoPose) {
  for (int i = 0; i < 2; ++i) {
    room_.fuse(i, room_.step(i).T_W_D);
    room_.session().conclude(true);
  }
  const ModelView* before = std::exchange(room_.view(), nullptr);
  Pose T_W_off = Pose::Identity();
  T_W_off.translation().x() = 1.0;
  room_.step(2, T_W_off);
  room_.prepareAhead(3);
  room_.session().conclude(false);
  room_.view() = before;
  const TrackingResult next = room_.step(3);
  ASSERT_EQ(next.status, TrackingStatus::kTracking) << next.reason;
  const Pose truth = roomFrames()[0].T_W_D->inverse() * *roomFrames()[3].T_W_D;
  EXPECT_LT((truth.inverse() * next.T_W_D).translation().norm(), 0.015);
}

TEST_P(TrackingSessionTest, EveryFrameWithAPoseIsToBeConcluded) {
  room_.step(0);
  expectError([&] { room_.step(1); }, {"not concluded"});
  room_.session().conclude(false);
  expectError([&] { room_.session().conclude(true); }, {"no frame is to be concluded"});
  EXPECT_EQ(room_.step(1).status, TrackingStatus::kTracking);
}

TEST_P(TrackingSessionTest, AnotherFrameThanTheOnePreparedIsAnError) {
  room_.fuse(0, room_.step(0).T_W_D);
  room_.prepareAhead(1);
  room_.session().conclude(true);
  expectError([&] { room_.step(2); }, {"not the one prepared ahead"});
  EXPECT_EQ(room_.step(1).status, TrackingStatus::kTracking);
}

Pose trueMotion(int from, int to) { return roomFrames()[from].T_W_D->inverse() * *roomFrames()[to].T_W_D; }

TEST(TrackingSessionPrior, AConfidentTextureThatDepthContradictsIsDropped) {
  for (const int misled : {1, 6}) {
    FusedRoom room(true);
    room.mislead(misled, poseFromTwist((Vector6d() << 0.0, 0.02, 0.0, 0.08, 0.0, 0.02).finished()));
    const std::vector<TrackingResult> results = room.trackAll(true);
    const TrackingResult& result = results[misled];
    EXPECT_LT((trueMotion(0, misled).inverse() * result.T_W_D).translation().norm(), 0.01) << misled;
    EXPECT_NE(result.prior, "texture") << misled;
    EXPECT_GT(result.prior_sigmas, 4.0) << misled;
    for (int i = 1; i < kFrames; ++i) EXPECT_EQ(results[i].dropped_prior, i == misled ? "texture" : "") << i;
  }
}

TEST_P(TrackingSessionTest, ASensorThatWasMovedWhileItWasLostIsSearchedFor) {
  room_.fuse(0, room_.step(0).T_W_D);
  room_.session().conclude(true);
  room_.session().reset(poseFromTwist((Vector6d() << 0.0, 0.1, 0.0, 0.1, 0.0, 0.05).finished()));
  const TrackingResult result = room_.step(1);
  ASSERT_NE(result.status, TrackingStatus::kLost) << result.reason;
  EXPECT_LT((trueMotion(0, 1).inverse() * result.T_W_D).translation().norm(), 0.015);
}

// In this share of the image, from the left, everything has come nearer.
RgbdFrame withThingsNearer(RgbdFrame frame, double share) {
  frame.depth = frame.depth.clone();
  cv::Mat things = frame.depth(cv::Rect(0, 0, cvRound(share * kCamera.width), kCamera.height));
  things *= 0.6;
  return frame;
}

// The map of one frame explains less than three tenths of the next.
TEST_P(TrackingSessionTest, LittleSufficesForAYoungMapIfTextureConfirmsIt) {
  room_.fuse(0, room_.step(0).T_W_D);
  room_.session().conclude(true);
  const TrackingResult result = room_.step(1, withThingsNearer(roomFrames()[1], 0.69));
  EXPECT_LT(result.explained, 0.3);
  if (GetParam()) {
    ASSERT_EQ(result.status, TrackingStatus::kTracking) << result.reason;
    EXPECT_LT((trueMotion(0, 1).inverse() * result.T_W_D).translation().norm(), 0.015);
  } else {
    EXPECT_EQ(result.status, TrackingStatus::kLost);
  }
}

// Something new stands in a part of the view: what is left of what is usual has to suffice.
TEST_P(TrackingSessionTest, ALostSensorIsFoundAlsoWhereNotAllIsAsItWas) {
  const int last = kFrames - 1;
  for (int i = 0; i < last; ++i) {
    room_.fuse(i, room_.step(i).T_W_D);
    room_.session().conclude(true);
  }
  room_.session().lose();
  const TrackingResult result = room_.step(last, withThingsNearer(roomFrames()[last], 0.17));
  ASSERT_NE(result.status, TrackingStatus::kLost) << result.reason;
  EXPECT_LT((trueMotion(0, last).inverse() * result.T_W_D).translation().norm(), 0.015);
}

struct SecondFrame {
  int i;
  double interval_s, readout_s;
  bool tells_that_first_is_bent;
};

// The sensor is as fast as the interval between the two frames is said to be short.
TEST(TrackingSessionYoungMap, AMapThatBeginsWithABentFrameIsGivenUp) {
  for (const SecondFrame& frame :
       {SecondFrame{1, 1.0 / 30.0, 0.03, false}, SecondFrame{1, 0.001, 0.03, true},
        SecondFrame{1, 0.001, 0.0, false}, SecondFrame{4, 0.1, 1.0, true}, SecondFrame{4, 0.2, 1.0, false}}) {
    PipelineParameters parameters = sessionParameters();
    parameters.preprocessing.readout_s = static_cast<float>(frame.readout_s);
    FusedRoom room(false, parameters);
    room.fuse(0, room.step(0).T_W_D);
    room.session().conclude(true);
    RgbdFrame second = roomFrames()[frame.i];
    second.stamp_s = roomFrames()[0].stamp_s + frame.interval_s;
    const TrackingResult result = room.step(frame.i, second);
    ASSERT_EQ(result.status, TrackingStatus::kTracking) << result.reason;
    EXPECT_FALSE(room.session().givesUpMap());
    room.session().conclude(true);
    EXPECT_EQ(room.session().givesUpMap(), frame.tells_that_first_is_bent) << frame.interval_s;
  }
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutTexture, TrackingSessionTest, testing::Bool());

}  // namespace
}  // namespace depth_fusion
