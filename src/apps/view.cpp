// Shows a model in a window.
#include "apps/command_line.h"
#include "apps/view/window.h"
#include "depth_fusion/common/error.h"
#include "depth_fusion/surface_mesh/mesh_picture.h"

namespace depth_fusion {
namespace {

constexpr char kDescription[] =
    "Shows a model: the folder of a `reconstruct`, with the sensor's way; a mesh (.ply, .obj, .glb, .dae,\n"
    ".stl), with its texture; a map that was saved, in a file or on a server; points (.pcd, .ply).\n\n"
    "In the window: drag to turn, with shift and the middle button to move, turn the wheel to come nearer.\n"
    "  n  the next paint: texture, colours, shaded, certainty, error, as far as the model has them\n"
    "  v  fly along the sensor's way, and stop\n"
    "  t  the sensor's way, on and off\n"
    "  b  what is seen from behind, on and off\n"
    "  shift and a click on two points: their distance;  m  none any more\n"
    "  r  all of it;  q  the end\n\n"
    "Examples:\n"
    "  view out\n"
    "  view kitchen.map --paint certainty\n"
    "  view out --paint error --truth room\n"
    "  view out/mesh.ply --screenshot mesh.png --view top\n";

struct Arguments {
  ModelSource source;
  WindowOptions window;
};

void addOptions(CLI::App& app, Arguments& arguments) {
  WindowOptions& window = arguments.window;
  app.option_defaults()->always_capture_default();
  app.add_option("model", window.model, "what is shown")->required();
  app.add_option("--paint", window.paint,
                 "how; a model without a texture has its colours, one without is shaded")
      ->check(CLI::IsMember(paintNames()));
  app.add_option("--view", window.view, "from where the model is seen at first")
      ->check(CLI::IsMember(viewNames()));
  app.add_option("--screenshot", window.screenshot, "write this picture instead of opening a window");
  app.add_option("--width", window.width, "of the window, pixels")->check(CLI::Range(64, 8192));
  app.add_option("--height", window.height, "of the window, pixels")->check(CLI::Range(64, 8192));
  app.add_flag("--behind", window.behind, "show what is seen from behind, too");
  app.add_flag("--no-way", window.without_way, "do not show the sensor's way");
  app.add_flag("--follow", window.follow, "show the model anew whenever its file has changed");
  app.add_option("--truth", arguments.source.truth,
                 "the simulated recording that the model was made of, for the paint error");
  app.add_option("--full-scale", arguments.source.full_scale_m, "metres of error that are red")
      ->check(CLI::PositiveNumber);
  app.add_option("--device", arguments.source.device,
                 "OpenCL device that reads maps: index, part of its name, cpu or gpu");
}

}  // namespace
}  // namespace depth_fusion

int main(int argc, char** argv) {
  using namespace depth_fusion;
  CLI::App app(kDescription, "view");
  Arguments arguments;
  addOptions(app, arguments);
  return runApp(app, [&] {
    app.parse(argc, argv);
    const WindowOptions& window = arguments.window;
    ModelSource& source = arguments.source;
    source.path = window.model;
    source.with_certainty = window.paint == "certainty";
    check(window.paint != "error" || !source.truth.empty(), "--paint error needs --truth");
    showWindow(window, [&] { return readModel(source); });
    return 0;
  });
}
