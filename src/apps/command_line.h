// What the command lines of the apps have in common.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "depth_fusion/common/parameters.h"
#include "depth_fusion/recording/recording.h"

namespace depth_fusion {

// Does what the app does, parsing included, and returns the exit status; what is thrown is said in one line.
inline int runApp(const CLI::App& app, const std::function<int()>& run) {
  try {
    return run();
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const std::exception& error) {
    std::cerr << app.get_name() << ": " << error.what() << std::endl;
    return 1;
  }
}

// Holds the files and numbers that tell the apps how to read a recording.
struct RecordingArguments {
  std::vector<std::string> parameter_files;
  std::string camera_file;
  std::vector<double> intrinsics;  // fx, fy, cx, cy
};

inline void addRecordingOptions(CLI::App& app, RecordingArguments& arguments, RecordingOptions& recording) {
  app.add_option(
      "--params", arguments.parameter_files,
      "YAML files of `stage: {name: value}`, the later over the earlier; see reconstruct --print-params");
  app.add_option(
      "--camera", arguments.camera_file,
      "camera file in place of the recording's: camera.yaml, or a calibration of ROS's camera_calibration, "
      "whose lens distortion is taken out");
  app.add_option("--intrinsics", arguments.intrinsics,
                 "fx,fy,cx,cy of the depth camera, instead of the recording's")
      ->delimiter(',')
      ->expected(4);
  app.add_option("--depth-topic", recording.depth_topic, "of a bag, instead of the one found");
  app.add_option("--color-topic", recording.color_topic, "of a bag, instead of the one found");
}

// The parameter files come first, then the options, whatever their order on the command line. Throws Error
// for a file that cannot be read.
inline void parse(CLI::App& app, int argc, char** argv, const RecordingArguments& arguments,
                  const ParameterTable& parameters, RecordingOptions& recording) {
  app.parse(argc, argv);
  if (!arguments.parameter_files.empty()) {
    for (const std::string& file : arguments.parameter_files) loadParameterFile(parameters, file);
    app.parse(argc, argv);
  }
  if (!arguments.camera_file.empty()) readCamera(arguments.camera_file, recording);
  const std::vector<double>& given = arguments.intrinsics;
  if (!given.empty()) recording.intrinsics = CameraIntrinsics{0, 0, given[0], given[1], given[2], given[3]};
}

}  // namespace depth_fusion
