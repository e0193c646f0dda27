#include "apps/view/model.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "apps/view/stored_model.h"
#include "depth_fusion/common/error.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "depth_fusion/surface_mesh/ply.h"
#include "tools/evaluation/mesh_error.h"
#include "tools/evaluation/trajectory_error.h"
#include "tools/simulation/scene_library.h"

namespace depth_fusion {
namespace {

constexpr MeshColor kGrey = {200, 212, 225};

// Whether its header names the file of a texture.
bool hasTexture(const std::string& ply) {
  std::ifstream file(ply);
  for (std::string line; std::getline(file, line) && line.rfind("end_header", 0) != 0;) {
    if (line.rfind("comment TextureFile", 0) == 0) return true;
  }
  return false;
}

ViewedModel readPlyOrPoints(const std::string& path) {
  if (hasTexture(path)) return readByAssimp(path);
  ViewedModel model;
  try {
    model.mesh = readPly(path);
  } catch (const Error&) {
    model.mesh = readByPcl(path);
  }
  return model;
}

ViewedModel readFolder(const std::string& folder) {
  const std::string mesh = folder + "/mesh.ply", way = folder + "/trajectory.txt";
  check(std::filesystem::exists(mesh),
        folder + " holds no mesh.ply; give the folder that `reconstruct --output` wrote");
  ViewedModel model;
  model.mesh = readPly(mesh);
  if (std::filesystem::exists(way) && std::filesystem::file_size(way) > 0) model.way = readTrajectory(way);
  return model;
}

MeshColor rainbow(float value) {
  cv::Mat color(1, 1, CV_8UC1, cv::Scalar(std::clamp(255.0f * value, 0.0f, 255.0f)));
  cv::applyColorMap(color, color, cv::COLORMAP_TURBO);
  const auto bgr = color.at<cv::Vec3b>(0, 0);
  return {bgr[2], bgr[1], bgr[0]};
}

ViewedModel readAny(const ModelSource& source) {
  const std::string ending = endingOf(source.path);
  if (std::filesystem::is_directory(source.path)) return readFolder(source.path);
  if (ending == "ply") return readPlyOrPoints(source.path);
  if (ending == "obj" || ending == "glb" || ending == "gltf" || ending == "dae")
    return readByAssimp(source.path);
  if (ending != "stl" && ending != "pcd")
    return readStoredModel(source.path, source.with_certainty, source.device);
  ViewedModel model;
  model.mesh = readByPcl(source.path);
  return model;
}

// The model lies where the sensor's way fits the true one best, or where the first camera was.
void measureErrors(const ModelSource& source, ViewedModel& model) {
  constexpr size_t kFewestPoses = 3;
  const Scene scene = makeScene(findSceneName(source.truth + "/")).surface;
  const Trajectory truth = readPoses(source.truth);
  check(!truth.empty(), source.truth + " has no true poses");
  const Pose T_W_M =
      model.way.size() < kFewestPoses ? truth.front().T_W_D : compareTrajectories(model.way, truth).T_W_E;
  TriangleMesh painted = model.mesh;
  paintError(painted, T_W_M, scene, static_cast<double>(source.full_scale_m));
  model.errors = std::move(painted.colors);
}

}  // namespace

ViewedModel readModel(const ModelSource& source) {
  ViewedModel model = readAny(source);
  check(!model.mesh.vertices.empty(), source.path + " holds nothing that could be shown");
  if (!source.truth.empty()) measureErrors(source, model);
  return model;
}

const std::vector<std::string>& paintNames() {
  static const std::vector<std::string> names = {"texture", "colors", "shaded", "certainty", "error"};
  return names;
}

std::vector<std::string> paintsOf(const ViewedModel& model) {
  std::vector<std::string> paints;
  if (!model.pages.empty()) paints.push_back("texture");
  if (!model.mesh.colors.empty()) paints.push_back("colors");
  paints.push_back("shaded");
  if (!model.certainties.empty()) paints.push_back("certainty");
  if (!model.errors.empty()) paints.push_back("error");
  return paints;
}

std::vector<MeshColor> colorsOf(const ViewedModel& model, const std::string& paint) {
  if (paint == "colors") return model.mesh.colors;
  if (paint == "error") return model.errors;
  std::vector<MeshColor> colors(model.mesh.vertices.size(), kGrey);
  if (paint != "certainty") return colors;
  constexpr int kSteps = 255;
  std::vector<MeshColor> of_step;
  for (int step = 0; step <= kSteps; ++step) of_step.push_back(rainbow(static_cast<float>(step) / kSteps));
  for (size_t i = 0; i < colors.size(); ++i)
    colors[i] = of_step[static_cast<size_t>(model.certainties[i] * kSteps)];
  return colors;
}

}  // namespace depth_fusion
