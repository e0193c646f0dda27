// The calibrate app, and what its calibration gains.
#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "depth_fusion/recording/recording_writer.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "support/apps.h"
#include "support/faulty_sensor.h"
#include "tools/evaluation/trajectory_error.h"

namespace depth_fusion {
namespace {

constexpr int kFrames = 90;
constexpr double kColorOffset_s = -0.01;  // its stamps are that much too late
const CameraIntrinsics kCamera{320, 240, 262.5, 262.5, 159.5, 119.5};

double bent(double x, double y) {
  return 0.006 + 0.02 * (x - 0.5) - 0.06 * (x - 0.5) * (x - 0.5) + 0.03 * (y - 0.5);
}

void setUnits(RgbdFrame& frame) {
  frame.depth_unit_m = 1.0 / 5000.0;
  frame.depth.convertTo(frame.depth, CV_16UC1, 5000.0);
}

void stampColorLater(const std::string& folder) {
  std::istringstream before(fileBytes(folder + "/rgb.txt"));
  std::ofstream after(folder + "/rgb.txt");
  after.precision(6);
  after << std::fixed;
  for (std::string line; std::getline(before, line);) {
    if (line[0] == '#') continue;
    const size_t space = line.find(' ');
    after << std::stod(line.substr(0, space)) - kColorOffset_s << line.substr(space) << "\n";
  }
}

void writeSwayingRecording(const std::string& folder, const SensorFaults& faults) {
  const FaultySensor sensor(kCamera, faults);
  const auto writer = createTumFolder(folder);
  for (int i = 0; i < kFrames; ++i) {
    const double time_s = 1.0 + i / 30.0;
    RgbdFrame frame = sensor.frameAt(time_s, i);
    frame.T_W_D = sensor.poseAt(time_s);
    setUnits(frame);
    writer->write(frame);
  }
  writer->finish();
  stampColorLater(folder);
}

void writeStillRecording(const std::string& folder, bool with_depth) {
  RgbdFrame frame = FaultySensor(kCamera, {}).frameAt(1.0, 1);
  setUnits(frame);
  if (!with_depth) frame.depth.setTo(0);
  const auto writer = createTumFolder(folder);
  for (int i = 0; i < 12; ++i) {
    writer->write(frame);
    frame.stamp_s += 1.0 / 30.0;
  }
  writer->finish();
}

double ateOf(const std::string& input, const std::string& output, const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"--input", input, "--output", output, "--no-mesh"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const AppRun run = runApp("reconstruct", arguments);
  EXPECT_EQ(run.status, 0) << run.errors;
  return compareTrajectories(readTrajectory(output + "/trajectory.txt"), readPoses(input)).ate_m.rmse;
}

TEST(Calibrate, FindsWhatIsWrongAndReconstructGainsByIt) {
  const TemporaryFolder folder;
  const std::string input = folder / "recording", output = folder / "calibrated";
  writeSwayingRecording(input, {bent, 0.0});
  const AppRun run =
      runApp("calibrate", {"--input", input, "--output", output, "--trajectory", input + "/groundtruth.txt"});
  ASSERT_EQ(run.status, 0) << run.errors;
  std::cout << run.output;

  const nlohmann::json report = readReport(output);
  EXPECT_GE(report["observed_offsets"], 40);
  const std::vector<double> offsets = report["offsets_per_m"], sigmas = report["offset_sigmas_per_m"];
  double squares = 0.0;
  for (size_t i = 0; i < offsets.size(); ++i)
    squares += std::pow(offsets[i] - bent(i % 8 / 7.0, i / 8 / 5.0), 2);
  EXPECT_LT(std::sqrt(squares / 48), 0.005);
  EXPECT_NEAR(report["readout_s"]["value"], 0.0, 0.01);
  EXPECT_NEAR(report["color_offset_s"]["value"], kColorOffset_s, 0.008);
  EXPECT_NEAR(report["pose_offset_s"]["value"], 0.0, 0.005);
  EXPECT_NEAR(report["depth_scale"]["value"], 1.0, 0.02);
  EXPECT_FALSE(cv::imread(output + "/calibration.png").empty());

  const double before_m = ateOf(input, folder / "before", {});
  const double after_m = ateOf(input, folder / "after", {"--params", output + "/calibration.yaml"});
  std::printf("ATE %.2f mm before, %.2f after\n", 1e3 * before_m, 1e3 * after_m);
  EXPECT_LT(after_m, 0.6 * before_m);
  const double self_m = ateOf(input, folder / "self", {"--self-calibrate"});
  std::printf("ATE %.2f mm with --self-calibrate\n", 1e3 * self_m);
  EXPECT_LT(self_m, 0.6 * before_m);
}

TEST(Calibrate, LeavesASoundSensorAlone) {
  const TemporaryFolder folder;
  writeSwayingRecording(folder / "recording", {});
  const AppRun run = runApp("calibrate", {"--input", folder / "recording", "--output", folder / "out"});
  ASSERT_EQ(run.status, 0) << run.errors;
  std::cout << run.output;
  const std::vector<double> offsets = readReport(folder / "out")["offsets_per_m"];
  for (const double offset : offsets) EXPECT_NEAR(offset, 0.0, 0.003);
}

TEST(Calibrate, ReconstructGoesOnWhereTheRecordingTellsNothing) {
  const TemporaryFolder folder;
  writeStillRecording(folder / "still", true);
  const AppRun run = runApp("reconstruct", {"--input", folder / "still", "--output", folder / "out",
                                            "--no-mesh", "--self-calibrate"});
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_NE(run.output.find("not calibrated: only"), std::string::npos) << run.output;
  EXPECT_EQ(readReport(folder / "out")["parameters"]["preprocessing/depth_offsets_per_m"], "");
}

TEST(Calibrate, RefusesWhatTellsNothingInOneLine) {
  const TemporaryFolder folder;
  const auto errorsOf = [&](const std::string& input) {
    const AppRun run = runApp("calibrate", {"--input", input, "--output", folder / "out"});
    EXPECT_EQ(run.status, 1);
    EXPECT_EQ(std::count(run.errors.begin(), run.errors.end(), '\n'), 1) << run.errors;
    EXPECT_FALSE(std::filesystem::exists(folder / "out/calibration.yaml"));
    return run.errors;
  };
  writeStillRecording(folder / "still", true);
  EXPECT_NE(errorsOf(folder / "still").find("move the sensor"), std::string::npos);
  writeStillRecording(folder / "blind", false);
  EXPECT_NE(errorsOf(folder / "blind").find("0 of 12 frames could be tracked"), std::string::npos);
  EXPECT_NE(errorsOf(folder / "nowhere").find("nowhere"), std::string::npos);
}

}  // namespace
}  // namespace depth_fusion
