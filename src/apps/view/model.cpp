#include "apps/view/model.h"

#include <algorithm>
#include <filesystem>
#include <opencv2/imgproc.hpp>

#include "apps/view/obj_file.h"
#include "apps/view/stored_model.h"
#include "depth_fusion/common/error.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "depth_fusion/surface_mesh/ply.h"

namespace depth_fusion {
namespace {

constexpr MeshColor kGrey = {200, 212, 225};

TriangleMesh readPlyOrPoints(const std::string& path) {
  try {
    return readPly(path);
  } catch (const Error&) {
    return readByPcl(path);
  }
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

std::string endingOf(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return ending;
}

MeshColor rainbow(float value) {
  cv::Mat color(1, 1, CV_8UC1, cv::Scalar(std::clamp(255.0f * value, 0.0f, 255.0f)));
  cv::applyColorMap(color, color, cv::COLORMAP_TURBO);
  const auto bgr = color.at<cv::Vec3b>(0, 0);
  return {bgr[2], bgr[1], bgr[0]};
}

}  // namespace

ViewedModel readModel(const std::string& path, bool with_certainty, const std::string& device) {
  const std::string ending = endingOf(path);
  if (std::filesystem::is_directory(path)) return readFolder(path);
  ViewedModel model;
  if (ending == ".ply") {
    model.mesh = readPlyOrPoints(path);
  } else if (ending == ".obj") {
    model.mesh = readObj(path);
  } else if (ending == ".stl" || ending == ".pcd") {
    model.mesh = readByPcl(path);
  } else {
    return readStoredModel(path, with_certainty, device);
  }
  check(!model.mesh.vertices.empty(), path + " holds nothing that could be shown");
  return model;
}

const std::vector<std::string>& paintNames() {
  static const std::vector<std::string> names = {"colors", "shaded", "certainty"};
  return names;
}

std::vector<std::string> paintsOf(const ViewedModel& model) {
  std::vector<std::string> paints;
  if (!model.mesh.colors.empty()) paints.push_back("colors");
  paints.push_back("shaded");
  if (!model.certainties.empty()) paints.push_back("certainty");
  return paints;
}

std::vector<MeshColor> colorsOf(const ViewedModel& model, const std::string& paint) {
  if (paint == "colors") return model.mesh.colors;
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
