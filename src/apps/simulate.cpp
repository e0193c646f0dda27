// Records a built-in scene with a simulated RGB-D sensor.
#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "apps/command_line.h"
#include "depth_fusion/common/error.h"
#include "ros/bags/open_recording.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

struct Arguments {
  std::string output;
  SimulationOptions simulation;
};

std::string sceneHelp() {
  std::string help = "what to record:";
  for (const SceneEntry& scene : sceneLibrary()) help += "\n  " + scene.name + ": " + scene.help;
  return help;
}

std::string walkHelp() {
  std::string help = "which way, in a scene that has several; the first is taken unless said:";
  for (const SceneEntry& entry : sceneLibrary()) {
    for (const Walk& walk : entry.make().walks)
      help += "\n  " + entry.name + ": " + walk.name + ", " + walk.help;
  }
  return help;
}

void addOptions(CLI::App& app, Arguments& arguments) {
  SimulationOptions& simulation = arguments.simulation;
  app.add_option(
         "-o,--output", arguments.output,
         "new folder (TUM layout: depth/, rgb/, groundtruth.txt, camera.yaml, scene.yaml), or FILE.bag")
      ->required();
  app.add_option("-s,--scene", simulation.scene, sceneHelp())->capture_default_str();
  app.add_option("-w,--walk", simulation.walk, walkHelp());
  app.add_option("-n,--frames", simulation.frames, "how many frames")->capture_default_str();
  app.add_flag("--noise,!--no-noise", simulation.noise,
               "the noise, quantisation and dropouts of the scene's sensor (default), or exact depth");
  app.add_flag("--lifelike", simulation.lifelike,
               "a rolling shutter, and colour with noise, automatic exposure and motion blur");
  app.add_option("--seed", simulation.seed, "another seed: another path of the hand and other noise")
      ->capture_default_str();
  app.add_option("--fps", simulation.fps, "frames per second")->capture_default_str();
  app.add_option("--speed", simulation.speed,
                 "speed of the hand; 1 is about 0.3 m/s and 25 deg/s in the room")
      ->capture_default_str();
  app.add_option("--linear-speed", simulation.linear_speed_m_s,
                 "speed of the hand in m/s at the recording's fastest moment, in place of --speed")
      ->check(CLI::PositiveNumber);
  app.add_option(
         "--turn-rate", simulation.turn_rate_deg_s,
         "rotation in deg/s at the recording's fastest moment, in place of --speed (room, white_room)")
      ->check(CLI::PositiveNumber);
  RobotOptions& robot = simulation.robot;
  app.add_flag("--wheels", robot.has_wheels,
               "the odometry of a robot's wheels, which drifts; kept in a bag only, as is --imu");
  app.add_option("--wheel-error", robot.wheel_scale_error, "by which part its distances are too long")
      ->capture_default_str();
  app.add_option("--slip", robot.slip_m, "how far the wheels slip after three seconds, in metres")
      ->capture_default_str();
  app.add_flag("--imu", robot.has_imu, "a gyroscope and an accelerometer with bias and noise, at 200 Hz");
  app.footer(
      "Example: simulate --output room --scene room --frames 300\n"
      "         reconstruct --input room --output out\n"
      "         evaluate --trajectory out/trajectory.txt --groundtruth room/groundtruth.txt \\\n"
      "                  --mesh out/mesh.ply --scene room\n\n"
      "The same arguments give the same recording, bit for bit. Depth is stored in steps of 0.2 mm\n"
      "(folder; seal: 0.01 mm) or 1 mm (bag, too coarse for the seal); poses are exact, of the depth\n"
      "camera in the scene's world (z up, origin on the floor).");
}

bool isBag(const std::string& output) { return std::filesystem::path(output).extension() == ".bag"; }

RgbdFrame asStored(RgbdFrame frame, double depth_unit_m) {
  frame.depth.convertTo(frame.depth, CV_16UC1, frame.depth_unit_m / depth_unit_m);
  frame.depth_unit_m = depth_unit_m;
  return frame;
}

// Prints a line that is overwritten on a terminal; elsewhere it prints one in fifty frames.
void showProgress(size_t frame, size_t frames) {
  const bool terminal = isatty(STDOUT_FILENO) != 0;
  if (terminal || frame % 50 == 0 || frame == frames) {
    std::printf("frame %zu/%zu%s", frame, frames, terminal && frame < frames ? "\r" : "\n");
  }
  std::fflush(stdout);
}

void simulate(const Arguments& arguments) {
  SimulatedRecording recording(arguments.simulation);
  const auto writer =
      isBag(arguments.output) ? createBag(arguments.output) : createTumFolder(arguments.output);
  if (!isBag(arguments.output)) writeSceneName(arguments.output, arguments.simulation.scene);
  std::printf("%s\n", recording.description().c_str());
  size_t written = 0;
  while (const std::optional<RgbdFrame> frame = recording.next()) {
    writer->write(asStored(*frame, recording.scene().sensor.depth_unit_m));
    showProgress(++written, recording.frameCount());
  }
  writer->finish();
  std::printf("written to %s\n", arguments.output.c_str());
}

}  // namespace
}  // namespace depth_fusion

int main(int argc, char** argv) {
  CLI::App app("Records a built-in scene with a simulated hand-held RGB-D sensor, with exact poses.",
               "simulate");
  depth_fusion::Arguments arguments;
  addOptions(app, arguments);
  return depth_fusion::runApp(app, [&] {
    app.parse(argc, argv);
    simulate(arguments);
    return 0;
  });
}
