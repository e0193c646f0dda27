#include "ros/output/textured_export.h"

#include <ros/console.h>
#include <ros/init.h>

#include <cmath>
#include <cstdio>

#include "depth_fusion/common/error.h"
#include "depth_fusion/texturing/keyframe_views.h"

namespace depth_fusion {
namespace {

std::string remarkOf(const TexturingReport& report) {
  char text[128];
  std::snprintf(text, sizeof(text),
                "%zu pictures show %.1f %% of the surface; steps of %.1f levels at %zu seams", report.chosen,
                100.0 * report.seen_area, report.seam_step, report.patches);
  return text;
}

}  // namespace

TexturedExport exportTextured(const std::string& path, const std::string& format, const TriangleMesh& mesh,
                              const Keyframes& keyframes, const TexturingParameters& parameters,
                              const std::function<void()>& go_on) {
  std::vector<TexturingView> views = viewsOf(keyframes);
  check(!views.empty(),
        "none of the map's " + std::to_string(keyframes.size()) +
            " keyframes has a picture; they have where colour comes with depth (color:=true)");
  const Texturing texturing =
      textureMesh(mesh, std::move(views), parameters, [&](const std::string& step, double done) {
        go_on();
        check(ros::ok(), "given up, for ROS shuts down");
        ROS_INFO_STREAM_THROTTLE(2.0, "export_mesh: " << step << ", " << std::lround(100.0 * done) << " %");
      });
  writeTexturedMesh(path, texturing.textured, UpAxis::kZ, format);
  const TriangleMesh& written = texturing.textured.mesh;
  return {{written.vertices.size(), written.triangles.size()}, remarkOf(texturing.report)};
}

}  // namespace depth_fusion
