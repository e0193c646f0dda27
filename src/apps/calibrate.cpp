// Measures the systematic errors of a depth sensor from a recording of an ordinary scene.
#include <filesystem>
#include <iostream>
#include <vector>

#include "apps/calibrate/report.h"
#include "apps/command_line.h"
#include "depth_fusion/common/error.h"
#include "depth_fusion/preprocessing/depth_correction.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "depth_fusion/registration/registered_recording.h"
#include "ros/bags/open_recording.h"
#include "tools/calibration/depth_scale.h"

namespace depth_fusion {
namespace {

constexpr char kDescription[] =
    "Measures what is wrong with a depth sensor, without a target: depth offsets over the image, the rolling "
    "shutter's\n"
    "readout, the time between depth and colour; with --trajectory or --distance the depth's scale, too. "
    "Move the sensor\n"
    "about a room for 10 to 30 s, half a metre each way, near and far, and let it see walls, floor and "
    "tables.\n"
    "Writes calibration.yaml (for --params of reconstruct, and params:= of the launch files), "
    "calibration.png and\n"
    "report.json. The calibration is for images as they are read here: with the same --camera.\n\n"
    "Examples:\n"
    "  calibrate --input room.bag --output calibrated\n"
    "  reconstruct --input desk.bag --output out --params calibrated/calibration.yaml\n";

struct Options {
  std::vector<std::string> inputs;
  std::string output, trajectory_file, device;
  RecordingArguments arguments;
  RecordingOptions recording;
  PipelineParameters parameters;
  TrackingRange range;
  Estimate distance_m{0.0, 0.005};
};

void addOptions(CLI::App& app, Options& options) {
  app.add_option("--input", options.inputs,
                 "recording: a folder, a .bag file, or several that are parts of one, as of reconstruct")
      ->required();
  app.add_option("--output", options.output, "folder for the results; made if missing")->required();
  addRecordingOptions(app, options.arguments, options.recording);
  app.add_option(
      "--trajectory", options.trajectory_file,
      "true poses (TUM format, or a folder that holds them): the depth's scale, and its stamps' delay");
  app.add_option("--distance", options.distance_m.value,
                 "metres, straight, from where the sensor is in the first frame to where it is in the last: "
                 "the depth's scale");
  app.add_option("--distance-sigma", options.distance_m.sigma, "how exact that distance is, metres")
      ->capture_default_str();
  app.add_option("--first-frame", options.range.first, "leave out the frames before")->capture_default_str();
  app.add_option("--max-frames", options.range.count, "stop after so many frames; 0: at the end")
      ->capture_default_str();
  app.add_option("--device", options.device, "OpenCL device, as of reconstruct");
}

void findScale(const Options& options, const Trajectory& truth, CalibrationReport& report) {
  const TrackedRecording& tracked = report.calibration.tracked;
  PipelineParameters& corrected = report.calibration.corrected;
  if (!truth.empty()) {
    report.poses = findTimeOffset(motionsOf(tracked.trajectory), truth);
    report.scale = scaleAgainst(tracked.trajectory, truth);
  } else if (options.distance_m.value > 0.0) {
    report.scale = scaleAgainst(tracked.trajectory, options.distance_m);
  }
  std::string& offsets = corrected.preprocessing.depth_offsets_per_m;
  if (report.scale) {
    // The offsets belong to the depth before it is scaled.
    corrected.registration.depth_scale *= static_cast<float>(report.scale->value);
    if (!offsets.empty()) offsets = depthOffsetsText(parseDepthOffsets(offsets) / report.scale->value);
  }
  if (report.poses && report.poses->found) {
    corrected.preprocessing.stamp_delay_s -= static_cast<float>(report.poses->offset_s.value);
  }
}

void calibrate(const Options& options) {
  ComputeContext compute(options.device);
  const auto open = [&] {
    return registered(openRecordings(options.inputs, options.recording), compute,
                      options.parameters.registration);
  };
  std::cout << "input: " << open()->description() << std::endl;
  std::string remark;
  const Trajectory truth =
      options.trajectory_file.empty() ? Trajectory() : readPoses(options.trajectory_file, &remark);
  if (!remark.empty()) std::cerr << "calibrate: " << remark << std::endl;
  std::filesystem::create_directories(options.output);

  CalibrationReport report;
  report.input = namesOf(options.inputs);
  report.calibration = calibrateFrom(compute, open, options.parameters, options.range,
                                     [](const std::string& text) { std::cout << text << std::endl; });
  // Times and scale are those of poses that the corrected depth gives.
  const TrackedRecording& tracked = report.calibration.tracked;
  report.color = findTimeOffset(tracked.color_motions, tracked.trajectory);
  if (!tracked.color_problem.empty() && !report.color.found)
    report.color.reason += " (" + tracked.color_problem + ")";
  findScale(options, truth, report);
  writeCalibration(options.output, report);
  std::cout << reportText(report) << "written: " << options.output
            << "/calibration.yaml, calibration.png, report.json" << std::endl;
}

}  // namespace
}  // namespace depth_fusion

int main(int argc, char** argv) {
  CLI::App app(depth_fusion::kDescription, "calibrate");
  depth_fusion::Options options;
  addOptions(app, options);
  return depth_fusion::runApp(app, [&] {
    parse(app, argc, argv, options.arguments, options.parameters.table(), options.recording);
    calibrate(options);
    return 0;
  });
}
