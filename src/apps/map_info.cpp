// Says what is in a stored map, checks it, and saves what can be read of a damaged one.
#include <cstdio>
#include <ctime>

#include "apps/command_line.h"
#include "depth_fusion/submaps/map_check.h"

namespace depth_fusion {
namespace {

constexpr char kDescription[] =
    "Says what is in a map that was saved, and reads all of it to check it. The exit status is 1 if "
    "something\n"
    "of it is damaged.\n\n"
    "Examples:\n"
    "  map_info kitchen.map\n"
    "  map_info postgresql://robot@maps.example/robots#kitchen\n"
    "  map_info damaged.map --rescue rescued.map\n";

struct Arguments {
  std::string map, rescued;
  bool parameters = false;
};

std::string timeText(double unix_s) {
  const auto seconds = static_cast<time_t>(unix_s);
  char text[64];
  std::strftime(text, sizeof(text), "%Y-%m-%d %H:%M:%S UTC", std::gmtime(&seconds));
  return text;
}

void sayProblems(const std::vector<std::string>& problems) {
  constexpr size_t kMost = 20;
  for (size_t i = 0; i < problems.size() && i < kMost; ++i) std::cerr << "map_info: " << problems[i] << "\n";
  if (problems.size() > kMost) std::cerr << "map_info: and " << problems.size() - kMost << " more\n";
}

void sayDescription(const MapDescription& map) {
  const Eigen::Vector3d p_W = map.last_pose.T_W_D.translation();
  std::cout << "written:    " << timeText(map.saved_at_s) << " by " << map.software << ", for the "
            << map.revision << ". time\n"
            << "voxels:     " << map.parameter("map/voxel_size_m") << " m, blocks of "
            << map.parameter("map/block_size") << "^3, truncation " << map.parameter("map/truncation_m")
            << " m, rule " << map.parameter("tsdf_fusion/rule") << "\n"
            << "camera:     " << sizeText(map.camera.width, map.camera.height) << ", focal length "
            << map.camera.fx << " px\n";
  std::printf("sensor:     last at (%.3f, %.3f, %.3f) m, stamp %.3f s\n", p_W.x(), p_W.y(), p_W.z(),
              map.last_pose.stamp_s);
  std::fflush(stdout);
}

int say(const Arguments& arguments) {
  const std::unique_ptr<Database> database = openDatabase(arguments.map, DatabaseAccess::kRead);
  const MapCheck found = checkMap(*database);
  std::cout << "map:        " << database->name() << ", " << database->bytes() << " bytes\n";
  sayDescription(found.description);
  std::cout << "submaps:    " << found.description.submaps.size() << "\n";
  for (const auto& [layer, blocks] : found.blocks)
    std::cout << "layer:      " << layer << ", " << blocks << " blocks in " << found.row_bytes.at(layer)
              << " bytes\n";
  std::cout << "keyframes:  " << found.keyframes << "\n";
  if (arguments.parameters) {
    for (const auto& [name, value] : found.description.parameters) std::cout << name << ": " << value << "\n";
  }
  sayProblems(found.problems);
  if (!found.problems.empty()) std::cout << "damaged:    see above; --rescue saves what can be read\n";
  return found.problems.empty() ? 0 : 1;
}

int rescue(const Arguments& arguments) {
  const MapRescue saved = rescueMap(arguments.map, arguments.rescued);
  sayProblems(saved.problems);
  std::cout << placeName(arguments.rescued) << ": " << saved.blocks << " blocks and " << saved.keyframes
            << " keyframes saved, " << saved.blocks_lost << " blocks lost" << std::endl;
  return 0;
}

}  // namespace
}  // namespace depth_fusion

int main(int argc, char** argv) {
  using namespace depth_fusion;
  CLI::App app(kDescription, "map_info");
  Arguments arguments;
  app.add_option("map", arguments.map, "a map's file, or postgresql://USER@HOST/DATABASE#NAME")->required();
  app.add_option("--rescue", arguments.rescued, "where what can be read of a damaged map is written");
  app.add_flag("--parameters", arguments.parameters, "list the parameters that the map was made with");
  return runApp(app, [&] {
    app.parse(argc, argv);
    return arguments.rescued.empty() ? say(arguments) : rescue(arguments);
  });
}
