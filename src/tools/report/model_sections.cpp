// What a report shows of the model.
#include "tools/report/charts.h"
#include "tools/report/html.h"
#include "tools/report/pictures.h"
#include "tools/report/sections.h"
#include "tools/report/web_model.h"

namespace depth_fusion {
namespace {

constexpr size_t kWebVertices = 160000;

std::string button(const std::string& action, const std::string& text) {
  return "<button data-do=\"" + action + "\">" + text + "</button>\n";
}

}  // namespace

std::string pictureSection(const TriangleMesh& mesh, const Trajectory& trajectory) {
  return "<section id=\"pictures\">\n<h2>Pictures</h2>\n<div class=\"pictures\">\n" +
         pictureFigures(mesh, trajectory) + "</div>\n</section>\n";
}

std::string modelSection(const TriangleMesh& mesh, const Trajectory& trajectory,
                         const std::string& viewer_command) {
  const TriangleMesh thin = thinned(mesh, kWebVertices);
  const std::string whole = grouped(mesh.triangles.size()) + " triangles";
  const std::string shown = thin.triangles.size() == mesh.triangles.size()
                                ? "It has " + whole + "."
                                : "Shown are " + grouped(thin.triangles.size()) +
                                      " triangles of <code>mesh.ply</code>'s " + whole + ".";
  return "<section id=\"interactive\">\n<h2>Model</h2>\n<canvas id=\"canvas\"></canvas>\n<div "
         "id=\"tools\">\n" +
         button("fly", "Fly along the way") + button("paint", "Colour or shaded") +
         button("way", "Way on or off") + button("behind", "Seen from behind, too") +
         button("start", "Back to the start") +
         "</div>\n<p class=\"soft\">Drag to turn, drag with shift or the right button to move, turn the "
         "wheel to come "
         "nearer; on a screen that is touched, two fingers do both. " +
         shown + (viewer_command.empty() ? "" : " All of it: <code>" + escaped(viewer_command) + "</code>") +
         "</p>\n" + modelElement(thin, trajectory) + "</section>\n";
}

std::string planSection(const TriangleMesh& mesh, const Trajectory& trajectory, const Trajectory& truth,
                        const std::vector<RecordedFrame>& frames) {
  std::string key;
  const auto add = [&](const char* color, const std::string& text) {
    key += std::string("<span style=\"--of:") + color + "\">" + text + "</span>\n";
  };
  for (const auto status : {TrackingStatus::kTracking, TrackingStatus::kDegenerate, TrackingStatus::kLost})
    add(colorOf(status), nameOf(status));
  add("#2f6fb2", "start");
  add("#1d242c", "end");
  if (!truth.empty()) add("#cfd6dc", "true way, behind");
  return "<section id=\"plan\">\n<h2>The sensor's way</h2>\n" + planOf(mesh, trajectory, truth, frames) +
         "<div class=\"key\">\n" + key + "</div>\n</section>\n";
}

}  // namespace depth_fusion
