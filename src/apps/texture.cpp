// Puts the pictures of a map, or of a recording, on its surface.
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "apps/texture/inputs.h"
#include "depth_fusion/common/error.h"
#include "depth_fusion/surface_mesh/mesh_finish.h"
#include "depth_fusion/surface_mesh/mesh_picture.h"
#include "texturing/view_image.h"
#include "tools/evaluation/picture_error.h"

namespace depth_fusion {
namespace {

constexpr char kDescription[] =
    "Puts pictures on a surface: a mesh with a texture, as glTF binary (.glb), OBJ (with MTL and PNG) or "
    "PLY\n"
    "(with PNG). The pictures are the keyframes of a map that was saved with colour, or the frames of a\n"
    "recording whose mesh and trajectory are known.\n\n"
    "Examples:\n"
    "  texture room.map --output room.glb\n"
    "  texture --input desk --reconstruction out --output desk.obj\n"
    "  texture --input desk --mesh out/mesh.ply --trajectory out/trajectory.txt --output desk.glb --share "
    "0.2\n";

struct Options {
  TextureArguments input;
  std::string reconstruction;
  MeshFinish finish;
  TexturingParameters texturing;
  std::vector<std::string> parameter_files;
  int keep_back = 0;
  bool z_up = false;
};

void addOptions(CLI::App& app, Options& options) {
  TextureArguments& input = options.input;
  auto* map = app.add_option("map", input.map, "a map's file, or postgresql://USER@HOST/DATABASE#NAME");
  auto* recording = app.add_option("--input", input.recording, "the recording, as reconstruct takes it");
  recording->excludes(map);
  app.add_option("--reconstruction", options.reconstruction,
                 "what reconstruct wrote of it: mesh.ply and trajectory.txt are taken from this folder");
  app.add_option("--mesh", input.mesh, "binary PLY file, in place of that mesh, or of the map's");
  app.add_option("--trajectory", input.trajectory,
                 "poses of the depth camera (TUM format, or a folder that holds poses), in place of those");
  app.add_option("-o,--output", input.output, "the mesh to write, MESH.glb, MESH.obj or MESH.ply")
      ->required();
  app.add_option("--color-camera", input.color_camera_file,
                 "camera file of a colour camera beside the depth camera, as of reconstruct");
  app.add_option("--camera", input.recording_arguments.camera_file,
                 "camera file in place of the recording's");
  app.add_option("--min-island", options.finish.min_island_m,
                 "smaller parts of the surface go, metres across");
  app.add_option("--max-hole", options.finish.max_hole_m, "holes up to this size are closed, metres across");
  app.add_option("--share", options.finish.share, "of the triangles to keep, above 0 and up to 1");
  app.add_option("--params", options.parameter_files, "YAML files of `texturing: {name: value}`");
  app.add_option("--keep-back", options.keep_back,
                 "every picture of this number is kept back and predicted, to say how well that is done")
      ->check(CLI::Range(2, 1000000));
  app.add_flag("--z-up", options.z_up, "up is z, as in a robot's map; without it -y, as of a level camera");
  app.add_option("--device", input.device, "OpenCL device: index, part of its name, cpu or gpu");
}

void say(const TexturingReport& report, double seconds) {
  std::printf("pictures:   %zu of %zu, the sharp ones apart from each other\n", report.chosen, report.views);
  std::printf(
      "alignment:  cameras moved by %.1f mm (median); colours differ by %.2f levels from their mean, %.2f "
      "before\n",
      1000.0 * report.move_m, report.misfit_after, report.misfit_before);
  std::printf(
      "coverage:   %zu of %zu faces, %.1f %% of the surface; the others have their vertices' colours\n",
      report.seen, report.faces, 100.0 * report.seen_area);
  std::printf("outliers:   %zu pictures of faces show something else, and were left out\n", report.outliers);
  std::printf(
      "seams:      %zu patches; colour steps by %.2f levels across their borders, by %.2f beside them\n",
      report.patches, report.seam_step, report.seam_gradient);
  std::printf("atlas:      %.0f %% full\n", 100.0 * report.fill);
  std::printf("time:       %.1f s\n", seconds);
}

// Shows each step once, and its percents on a terminal's line.
class Progress {
 public:
  void operator()(const std::string& step, double done) {
    if (step != step_) std::fprintf(stderr, "%s%s", step_.empty() ? "" : "\n", step.c_str());
    step_ = step;
    if (done > 0.0) std::fprintf(stderr, "\r%s: %3.0f %%", step.c_str(), 100.0 * done);
  }
  void finish() const { std::fprintf(stderr, "\n"); }

 private:
  std::string step_;
};

void sayPredictions(const TexturedMesh& textured, const TriangleMesh& mesh,
                    const std::vector<TexturingView>& kept_back) {
  double by_texture = 0.0, by_vertices = 0.0;
  int count = 0;
  for (const TexturingView& view : kept_back) {
    const cv::Mat picture = imageOf(view);
    const Pose T_W_C = fittedPose(textured, view);
    const TexturedPicture predicted = renderTexturedMesh(textured, view.camera, T_W_C);
    const cv::Mat covered = predicted.depth > 0.0f;
    const PictureError error = comparePictures(predicted.color, picture, covered);
    if (error.pixels == 0) continue;
    by_texture += error.psnr_db;
    by_vertices += comparePictures(renderMesh(mesh, view.camera, T_W_C), picture, covered).psnr_db;
    ++count;
  }
  std::printf(
      "kept back:  %d pictures, predicted to %.2f dB (PSNR, mean) by the texture, %.2f dB by the vertices' "
      "colours\n",
      count, by_texture / std::max(count, 1), by_vertices / std::max(count, 1));
}

int texture(Options& options) {
  for (const std::string& file : options.parameter_files)
    loadParameterFile(withPrefix("texturing", options.texturing.table()), file);
  checkFinish(options.finish);
  checkTexturedPath(options.input.output);
  if (!options.reconstruction.empty()) {
    if (options.input.mesh.empty()) options.input.mesh = options.reconstruction + "/mesh.ply";
    if (options.input.trajectory.empty())
      options.input.trajectory = options.reconstruction + "/trajectory.txt";
  }
  check(!options.input.map.empty() || !options.input.recording.empty(),
        "a map or --input is needed; see --help");
  TextureInput input = readTextureInput(options.input);
  FinishedMesh mesh = finished(std::move(input.mesh), options.finish);
  if (!mesh.remark.empty()) std::printf("mesh:       %s\n", mesh.remark.c_str());
  std::vector<TexturingView> used, kept_back;
  for (size_t i = 0; i < input.views.size(); ++i) {
    const bool is_kept = options.keep_back > 0 && (i + 1) % static_cast<size_t>(options.keep_back) == 0;
    (is_kept ? kept_back : used).push_back(std::move(input.views[i]));
  }
  const auto start = std::chrono::steady_clock::now();
  Progress progress;
  const Texturing result = textureMesh(mesh.mesh, std::move(used), options.texturing,
                                       [&](const std::string& step, double done) { progress(step, done); });
  progress.finish();
  say(result.report, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  if (!kept_back.empty()) sayPredictions(result.textured, mesh.mesh, kept_back);
  writeTexturedMesh(options.input.output, result.textured, options.z_up ? UpAxis::kZ : UpAxis::kMinusY);
  std::printf("%s: %zu triangles, %zu pages\n", options.input.output.c_str(),
              result.textured.mesh.triangles.size(), result.textured.pages.size());
  return 0;
}

}  // namespace
}  // namespace depth_fusion

int main(int argc, char** argv) {
  using namespace depth_fusion;
  CLI::App app(kDescription, "texture");
  Options options;
  addOptions(app, options);
  return runApp(app, [&] {
    app.parse(argc, argv);
    const RecordingArguments& given = options.input.recording_arguments;
    if (!given.camera_file.empty()) readCamera(given.camera_file, options.input.recording_options);
    return texture(options);
  });
}
