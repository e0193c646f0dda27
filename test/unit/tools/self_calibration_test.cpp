// What was found is tracked again, and not applied if the map then explains the frames less well.
#include "tools/calibration/self_calibration.h"

#include <gtest/gtest.h>

#include "support/faulty_sensor.h"
#include "support/test_compute.h"

namespace depth_fusion {
namespace {

constexpr int kFrames = 60;
const CameraIntrinsics kCamera{320, 240, 262.5, 262.5, 159.5, 119.5};

// What a sensor sees whose offsets are so many times those of a bent one.
class SwayingRecording : public Recording {
 public:
  explicit SwayingRecording(double bend)
      : sensor_(kCamera, {[bend](double x, double y) {
                            return bend * (0.006 - 0.06 * (x - 0.5) * (x - 0.5) + 0.03 * (y - 0.5));
                          },
                          0.0}) {}

  std::optional<RgbdFrame> next() override {
    if (next_ == kFrames) return std::nullopt;
    const double time_s = 1.0 + next_ / 30.0;
    return sensor_.frameAt(time_s, next_++);
  }
  size_t frameCount() const override { return kFrames; }
  std::string description() const override { return "a swaying sensor"; }

 private:
  FaultySensor sensor_;
  int next_ = 0;
};

SelfCalibration calibrate(double bend, double bend_when_tracked_again) {
  int opened = 0;
  const OpenRecording open = [&] {
    return std::make_unique<SwayingRecording>(opened++ == 0 ? bend : bend_when_tracked_again);
  };
  return calibrateFrom(compute(), open, {}, {}, [](const std::string&) {});
}

TEST(SelfCalibration, AppliesWhatTheMapConfirms) {
  const SelfCalibration calibration = calibrate(1.0, 1.0);
  EXPECT_FALSE(calibration.refused);
  EXPECT_FALSE(calibration.corrected.preprocessing.depth_offsets_per_m.empty());
  EXPECT_GT(calibration.tracked.explained, calibration.explained_before);
}

// Whatever the reason is that it does not fit: here the sensor has become another one.
TEST(SelfCalibration, AppliesNothingThatTheMapDoesNotConfirm) {
  const SelfCalibration calibration = calibrate(1.0, -1.0);
  EXPECT_TRUE(calibration.refused);
  EXPECT_TRUE(isApplied(calibration.depth, CalibrationPart::kShape))
      << "frames that were held out confirm it";
  EXPECT_EQ(calibration.corrected.preprocessing.depth_offsets_per_m, "");
  EXPECT_EQ(calibration.tracked.explained, calibration.explained_before);
  EXPECT_NE(calibrationText(calibration).find("NOTHING IS APPLIED"), std::string::npos);
}

}  // namespace
}  // namespace depth_fusion
