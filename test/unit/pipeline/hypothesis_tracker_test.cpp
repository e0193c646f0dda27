// What is refused: poses by which the map explains less than usual, or fits worse.
#include "depth_fusion/pipeline/hypothesis_tracker.h"

#include <gtest/gtest.h>

#include "depth_fusion/compute/device_image.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"
#include "support/room_frames.h"
#include "support/test_compute.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kCamera{320, 240, 262.5, 262.5, 159.5, 119.5};

constexpr double kOff_m = 0.006;  // less than the sensor's noise

TrackingResult found(double explained, double match_quality) {
  TrackingResult result;
  result.status = TrackingStatus::kTracking;
  result.inlier_fraction = explained;
  result.explained = explained;
  result.match_quality = match_quality;
  return result;
}

const RgbdFrame& roomFrame() {
  static const RgbdFrame frame = simulateRoom(kCamera, 1).front();
  return frame;
}

// In this share of the image, from the left, everything has come nearer.
RgbdFrame withThingsNearer(double share) {
  RgbdFrame frame = roomFrame();
  frame.depth = frame.depth.clone();
  cv::Mat things = frame.depth(cv::Rect(0, 0, cvRound(share * kCamera.width), kCamera.height));
  things *= 0.6;
  return frame;
}

class Refusals : public testing::Test {
 protected:
  Refusals() : preprocessor_(compute(), {}, kCamera) {
    const DepthFrame& frame = preprocessor_.process(roomFrame());
    view_ = {kCamera, Pose::Identity(), zeroImage(compute(), kCamera), zeroImage(compute(), kCamera)};
    for (auto [from, to] : {std::pair(&frame.levels[0].depth, &view_.depth),
                            std::pair(&frame.levels[0].normals, &view_.normals)})
      to->copyFrom(*from, from->bytes());
    compute().finish();
  }

  // Has seen so many frames that were explained and fitted like this.
  void see(int frames, double explained, double match_quality) {
    for (int i = 0; i < frames; ++i) tracker_.accept(found(explained, match_quality));
  }
  // Tracks the frame from where it was taken.
  TrackingResult track(const RgbdFrame& frame) {
    const MotionPrior prior{Pose::Identity(), std::nullopt, "last pose"};
    return tracker_.track(preprocessor_.process(frame), view_, prior, {prior}, timers_);
  }
  void expectFound(const TrackingResult& result) {
    EXPECT_EQ(result.status, TrackingStatus::kTracking) << result.reason << " " << result.explained;
  }
  void expectLost(const TrackingResult& result, const std::string& reason) {
    EXPECT_EQ(result.status, TrackingStatus::kLost) << result.explained;
    EXPECT_NE(result.reason.find(reason), std::string::npos) << result.reason;
  }

  DepthPreprocessor preprocessor_;
  ModelView view_;
  HypothesisTracker tracker_{compute(), {}, kCamera};
  StageTimers timers_;
};

TEST_F(Refusals, ALostSensorIsFoundByThreeQuartersOfWhatIsUsual) {
  see(10, 0.8, 0.9);
  expectFound(tracker_.orStillLost(found(0.62, 0.9)));
  expectLost(tracker_.orStillLost(found(0.58, 0.9)), "may be a wrong one");
}

TEST_F(Refusals, ByAMapOfFewFramesALostSensorIsFoundByLess) {
  see(4, 0.8, 0.9);
  expectFound(tracker_.orStillLost(found(0.35, 0.9)));
  expectLost(tracker_.orStillLost(found(0.25, 0.9)), "may be a wrong one");
}

TEST_F(Refusals, ALostSensorIsNotFoundWherePlacesMayLookAlike) {
  see(10, 0.8, 0.9);
  TrackingResult result = found(0.8, 0.9);
  result.weakest_said = 0.7;
  expectFound(tracker_.orStillLost(result));
  result.weakest_said = 0.5;
  expectLost(tracker_.orStillLost(result), "look alike");
}

TEST_F(Refusals, AFrameOfWhichTheMapExplainsHalfIsLost) {
  see(10, 0.9, 0.9);
  expectFound(track(withThingsNearer(0.3)));
  expectLost(track(withThingsNearer(0.55)), "may be a wrong one");
}

TEST_F(Refusals, AFrameWhoseMatchesFitWorseThanUsualIsLost) {
  const double match_quality = track(roomFrame()).match_quality;
  see(10, 0.9, match_quality / 0.9);
  expectFound(track(roomFrame()));
  see(200, 0.9, match_quality / 0.8);
  expectLost(track(roomFrame()), "may be a wrong one");
}

// A prior that is sure of itself holds the pose a little off, so that hardly less of the frame is explained.
TEST_F(Refusals, APriorThatDepthContradictsIsDroppedAlsoWhereItsPoseFits) {
  const TrackingResult usual = track(roomFrame());
  see(10, usual.explained, usual.match_quality);
  MotionPrior prior{Pose::Identity(), Matrix6d(1e-9 * Matrix6d::Identity()), "texture"};
  prior.T_W_D.translation().z() = kOff_m;
  const DepthFrame& frame = preprocessor_.process(roomFrame());
  const TrackingResult held = tracker_.track(frame, view_, prior, {}, timers_);
  expectFound(held);
  EXPECT_GT(held.explained, 0.92 * usual.explained);
  EXPECT_GT(held.T_W_D.translation().norm(), 0.5 * kOff_m);
  EXPECT_GT(held.prior_sigmas, 4.0);

  const MotionPrior last{Pose::Identity(), std::nullopt, "last pose"};
  const TrackingResult result = tracker_.track(frame, view_, prior, {last}, timers_);
  expectFound(result);
  EXPECT_EQ(result.dropped_prior, "texture");
  EXPECT_LT(result.T_W_D.translation().norm(), 0.2 * kOff_m);
}

}  // namespace
}  // namespace depth_fusion
