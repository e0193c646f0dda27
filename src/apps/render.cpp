// render draws a picture of a mesh.
#include <iostream>

#include "apps/command_line.h"
#include "common/io/image_file.h"
#include "depth_fusion/common/error.h"
#include "depth_fusion/surface_mesh/mesh_picture.h"
#include "depth_fusion/surface_mesh/ply.h"

namespace depth_fusion {
namespace {

struct Options {
  std::string mesh;
  std::string output = "mesh.png";
  std::string view = viewNames().front();
  std::vector<double> pose;  // tx ty tz qx qy qz qw
  int width = 1280;
  int height = 960;
  double view_deg = 60.0;
  bool shaded = false;
  bool open = false;
};

void addOptions(CLI::App& app, Options& options) {
  app.option_defaults()->always_capture_default();
  app.add_option("--mesh", options.mesh, "binary PLY file, as reconstruct writes it")->required();
  app.add_option("--output", options.output, "picture to write; the name's ending tells the format");
  auto* view = app.add_option("--view", options.view, "from where the mesh is seen as a whole")
                   ->check(CLI::IsMember(viewNames()));
  app.add_option("--pose", options.pose,
                 "camera instead of a view: tx ty tz qx qy qz qw, as in trajectory.txt")
      ->expected(7)
      ->excludes(view);
  app.add_option("--width", options.width, "of the picture, pixels")->check(CLI::Range(16, 16384));
  app.add_option("--height", options.height, "of the picture, pixels")->check(CLI::Range(16, 16384));
  auto* shaded =
      app.add_flag("--shaded", options.shaded, "grey and lit from the camera, even if the mesh has colours");
  app.add_flag("--open", options.open, "leave out what is seen from behind: look into a room from outside")
      ->excludes(shaded);
  app.add_option("--field-of-view", options.view_deg, "horizontal, degrees")->check(CLI::Range(1.0, 170.0));
}

Pose poseFrom(const std::vector<double>& numbers) {
  const Eigen::Quaterniond rotation(numbers[6], numbers[3], numbers[4], numbers[5]);
  check(rotation.norm() > 0.0, "--pose: the quaternion qx qy qz qw is zero");
  Pose T_W_C = Pose::Identity();
  T_W_C.linear() = rotation.normalized().toRotationMatrix();
  T_W_C.translation() = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
  return T_W_C;
}

void render(const Options& options) {
  const TriangleMesh mesh = readPly(options.mesh);
  const CameraIntrinsics camera =
      pictureCamera(options.width, options.height, options.view_deg * CV_PI / 180.0);
  const Pose T_W_C = options.pose.empty() ? viewOf(mesh, camera, options.view) : poseFrom(options.pose);
  const MeshPaint paint = options.shaded ? MeshPaint::kShaded
                          : options.open ? MeshPaint::kOpen
                                         : MeshPaint::kColors;
  writePicture(options.output, renderMesh(mesh, camera, T_W_C, paint));
  std::cout << options.output << ": " << mesh.triangles.size() << " triangles\n";
}

}  // namespace
}  // namespace depth_fusion

int main(int argc, char** argv) {
  CLI::App app(
      "Draws a picture of a mesh: in its colours, dark where seen from behind, or shaded in grey and red.",
      "render");
  depth_fusion::Options options;
  addOptions(app, options);
  return depth_fusion::runApp(app, [&] {
    app.parse(argc, argv);
    render(options);
    return 0;
  });
}
