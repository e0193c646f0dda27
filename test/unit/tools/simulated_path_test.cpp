// Where the simulated hand goes and how fast.
#include <gtest/gtest.h>

#include <algorithm>

#include "depth_fusion/geometry/angles.h"
#include "support/expect_error.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

struct Rates {
  double length_m = 0.0, turn_deg = 0.0;    // summed
  double peak_m_s = 0.0, peak_deg_s = 0.0;  // of one frame to the next
  double clearance_m = 1e9;                 // to the nearest surface
};

Rates ratesOf(const SimulationOptions& options) {
  const SimulatedRecording simulated(options);
  Rates rates;
  for (int i = 0; i < options.frames; ++i) {
    const Pose T_W_D = simulated.poseOf(i).T_W_D;
    const Pose motion = T_W_D.inverse() * simulated.poseOf(i + 1).T_W_D;
    const double step_m = motion.translation().norm(), turn_deg = rotationAngle(motion) * kDegPerRad;
    rates.length_m += step_m;
    rates.turn_deg += turn_deg;
    rates.peak_m_s = std::max(rates.peak_m_s, step_m * options.fps);
    rates.peak_deg_s = std::max(rates.peak_deg_s, turn_deg * options.fps);
    rates.clearance_m = std::min(rates.clearance_m, simulated.scene().surface.distance(T_W_D.translation()));
  }
  return rates;
}

struct Expected {
  const char* scene;
  double clearance_m, speed_m_s, turn_deg_s;
};

class PathTest : public testing::TestWithParam<Expected> {};

TEST_P(PathTest, StaysInFreeSpaceAndIsSmooth) {
  const Expected& expected = GetParam();
  SimulationOptions options;
  options.scene = expected.scene;
  options.frames = 1800;
  for (options.seed = 0; options.seed < 5; ++options.seed) {
    const Rates rates = ratesOf(options);
    EXPECT_GE(rates.clearance_m, expected.clearance_m);
    EXPECT_LT(rates.peak_m_s, 0.9);
    EXPECT_LT(rates.peak_deg_s, 60.0);
    EXPECT_NEAR(rates.length_m / 60.0, expected.speed_m_s, 0.2 * expected.speed_m_s);
    EXPECT_NEAR(rates.turn_deg / 60.0, expected.turn_deg_s, 0.2 * expected.turn_deg_s);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Library, PathTest,
    testing::Values(Expected{"room", 0.5, 0.3, 25.0}, Expected{"white_room", 0.5, 0.3, 25.0},
                    Expected{"object", 0.1, 0.17, 25.0}, Expected{"wall", 0.85, 0.31, 5.4},
                    Expected{"floor_wall", 0.9, 0.31, 5.4}, Expected{"cylinder", 0.8, 0.3, 15.0}));

class DegeneratePathTest : public testing::TestWithParam<std::string> {};

TEST_P(DegeneratePathTest, IsThreeMetresLongIn300Frames) {
  SimulationOptions options;
  options.scene = GetParam();
  for (options.seed = 1; options.seed < 6; ++options.seed) {
    EXPECT_NEAR(ratesOf(options).length_m, 3.1, 0.15) << options.seed;
  }
}

TEST_P(DegeneratePathTest, TremblesInAllSixDegreesOfFreedom) {
  SimulationOptions options;
  options.scene = GetParam();
  const SimulatedRecording simulated(options);
  Vector6d tremor = Vector6d::Zero();  // second differences, in which the walk hardly shows
  const auto motionAt = [&](int i) {
    const Pose motion = simulated.poseOf(i).T_W_D.inverse() * simulated.poseOf(i + 1).T_W_D;
    const Eigen::AngleAxisd turn(motion.linear());
    Vector6d twist;
    twist << turn.angle() * turn.axis(), motion.translation();
    return twist;
  };
  for (int i = 0; i < options.frames; ++i)
    tremor += (motionAt(i + 1) - motionAt(i)).cwiseAbs() / options.frames;
  EXPECT_GT(tremor.head<3>().minCoeff(), 0.0002) << tremor.transpose();
  EXPECT_GT(tremor.tail<3>().minCoeff(), 0.00005) << tremor.transpose();
  EXPECT_LT(tremor.maxCoeff(), 0.002) << tremor.transpose();
}

INSTANTIATE_TEST_SUITE_P(Library, DegeneratePathTest, testing::Values("wall", "floor_wall", "cylinder"));

TEST(HandSpeed, PeakRatesAreThoseAskedFor) {
  constexpr double kTremor_m_s = 0.03, kTremor_deg_s = 4.0;
  SimulationOptions options;
  options.linear_speed_m_s = 0.5;
  options.turn_rate_deg_s = 60.0;
  for (options.seed = 1; options.seed < 6; ++options.seed) {
    const Rates rates = ratesOf(options);
    EXPECT_GT(rates.peak_m_s, 0.5 - kTremor_m_s);
    EXPECT_LT(rates.peak_m_s, 0.5 + kTremor_m_s);
    EXPECT_GT(rates.peak_deg_s, 60.0 - kTremor_deg_s);
    EXPECT_LT(rates.peak_deg_s, 60.0 + kTremor_deg_s);
  }
}

TEST(HandSpeed, EachRateLeavesTheOtherAlone) {
  const Rates own = ratesOf({});
  SimulationOptions options;
  options.turn_rate_deg_s = 60.0;
  EXPECT_NEAR(ratesOf(options).length_m, own.length_m, 0.1 * own.length_m);
  options.turn_rate_deg_s = 0.0;
  options.linear_speed_m_s = 0.8;
  EXPECT_NEAR(ratesOf(options).turn_deg, own.turn_deg, 0.02 * own.turn_deg);
}

TEST(HandSpeed, RatesThatMakeNoSenseAreErrors) {
  SimulationOptions options;
  options.linear_speed_m_s = -1.0;
  expectError([&] { SimulatedRecording{options}; }, {"linear speed", "negative"});
  options = {};
  options.scene = "cylinder";
  options.turn_rate_deg_s = 60.0;
  expectError([&] { SimulatedRecording{options}; }, {"'cylinder'", "turn rate", "linear speed"});
}

}  // namespace
}  // namespace depth_fusion
