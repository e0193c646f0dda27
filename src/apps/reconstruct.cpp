// Fuses a recording into a mesh.
#include <iostream>

#include "apps/command_line.h"
#include "apps/reconstruct/run.h"
#include "apps/reconstruct/self_calibrate.h"
#include "depth_fusion/common/error.h"
#include "depth_fusion/pipeline/stored_map.h"
#include "depth_fusion/submaps/map_file.h"

namespace depth_fusion {
namespace {

constexpr char kDescription[] =
    "Fuses an RGB-D recording into a surface: mesh.ply, trajectory.txt (TUM format) and report.json.\n"
    "The recording is a folder in the TUM or 7-Scenes layout, a .bag file or an .oni file; which one\n"
    "it is, is found out by looking.\n"
    "The world frame is the first camera's (x right, y down, z forward), or that of --trajectory.\n\n"
    "Examples:\n"
    "  reconstruct --input desk --output out\n"
    "  reconstruct --input desk.bag --output out --voxel-size 0.01 --max-range 4\n"
    "  reconstruct --input desk_0.bag desk_1.bag --output out\n"
    "  reconstruct --input desk --output out --trajectory poses.txt\n"
    "  reconstruct --input desk --output out --map desk.map\n"
    "  reconstruct --input desk_again --output out_again --continue desk.map\n";

void listDevices() {
  const std::vector<DeviceInfo> devices = ComputeContext::listDevices();
  for (size_t i = 0; i < devices.size(); ++i) {
    std::cout << "[" << i << "] " << devices[i].name << " (" << devices[i].platform << ", "
              << devices[i].version << ", " << (devices[i].memory_bytes >> 20) << " MiB)\n";
  }
  if (devices.empty()) std::cout << "no OpenCL device; the package pocl-opencl-icd brings one for the CPU\n";
}

struct Arguments {
  RecordingArguments recording;
  std::string color_camera_file;
  bool print_parameters = false;
};

void addOptions(CLI::App& app, Arguments& arguments, RunOptions& options) {
  MapParameters& map = options.parameters.map;
  app.add_option("--input", options.inputs,
                 "recording to fuse: a folder, a .bag file, several that are parts of one, or an .oni file");
  app.add_option("--output", options.output, "folder for the results; made if missing");
  app.add_option("--voxel-size", map.voxel_size_m, "edge of a voxel in metres")->capture_default_str();
  app.add_option("--blocks-per-axis", map.blocks_per_axis, "the window's size in blocks, N")
      ->capture_default_str();
  app.add_option("--block-size", map.block_size, "voxels per block axis, M: 4, 8, 16 or 32")
      ->capture_default_str();
  app.add_option("--truncation", map.truncation_m,
                 "distance kept on both sides of a surface, metres; 0 = four voxels")
      ->capture_default_str();
  app.add_option("--max-range", options.parameters.preprocessing.max_range_m, "farthest depth used, metres")
      ->capture_default_str();
  addRecordingOptions(app, arguments.recording, options.recording);
  app.add_option(
      "--color-camera", arguments.color_camera_file,
      "camera file of a colour camera beside the depth camera, with depth_to_color; see cfg/cameras");
  app.add_option("--trajectory", options.trajectory_file,
                 "fuse at these poses (TUM format, or a folder that holds poses) instead of tracking");
  app.add_option("--map", options.map,
                 "save the map there in the end: a file, or postgresql://USER@HOST/DATABASE#NAME");
  app.add_option("--continue", options.continued,
                 "go on with the map that is stored there, in its frame; it is saved there unless --map says "
                 "otherwise");
  app.add_option("--max-frames", options.max_frames, "stop after so many frames")
      ->check(CLI::Range(1, 1000000000));
  app.add_option("--device", options.device,
                 "OpenCL device: index, part of its name, cpu or gpu; `list` shows them");
  app.add_flag("--color", map.color, "fuse colour, too: mesh.ply has the vertices' colours");
  app.add_flag(
      "--self-calibrate", options.self_calibrate,
      "find what the depth is off by from the recording (its first 1000 frames are read twice more), "
      "and correct it; see docs/calibration.md");
  app.add_flag("--single-pass", options.single_pass,
               "seek no loops: the map is what was fused while tracking; see docs/loops.md");
  app.add_flag("--report", options.report,
               "report.html, too: pictures, the model to be turned in a browser, tracking, times, errors "
               "where the recording has the truth, and what to try; see docs/viewing.md");
  auto* view = app.add_flag("--view", options.view,
                            "a window that shows the scan while it grows, and stays; see docs/viewing.md");
  app.add_flag("--no-mesh", options.no_mesh, "track and fuse only, for timing")->excludes(view);
  app.add_flag("--print-params", arguments.print_parameters,
               "list every parameter with its value, range and meaning");
}

void printParameters(const ParameterTable& parameters) {
  for (const Parameter& parameter : parameters) {
    std::cout << parameter.name << ": " << valueText(parameter) << "   # " << rangeText(parameter) << " "
              << helpText(parameter) << "\n";
  }
}

// A file that is no good costs colour, not depth.
void readColorCameraOrProblem(const std::string& file, RecordingOptions& recording) {
  try {
    if (!file.empty()) readColorCamera(file, recording);
  } catch (const Error& error) {
    recording.color_problem = error.what();
  }
}

int run(const Arguments& arguments, RunOptions& options) {
  readColorCameraOrProblem(arguments.color_camera_file, options.recording);
  if (options.device == "list") {
    listDevices();
    return 0;
  }
  if (!options.continued.empty()) {
    options.stored = openDatabase(options.continued, DatabaseAccess::kRead);
    adoptParameters(describeMap(*options.stored), options.parameters);
    if (options.map.empty()) options.map = options.continued;
  }
  validate(options.parameters.table());
  if (arguments.print_parameters) {
    printParameters(options.parameters.table());
    return 0;
  }
  check(!options.inputs.empty() && !options.output.empty(), "--input and --output are needed; see --help");
  return reconstruct(options.self_calibrate ? selfCalibrated(options) : options);
}

}  // namespace
}  // namespace depth_fusion

int main(int argc, char** argv) {
  CLI::App app(depth_fusion::kDescription, "reconstruct");
  depth_fusion::Arguments arguments;
  depth_fusion::RunOptions options;
  addOptions(app, arguments, options);
  return depth_fusion::runApp(app, [&] {
    parse(app, argc, argv, arguments.recording, options.parameters.table(), options.recording);
    return run(arguments, options);
  });
}
