// The real recording bloster_texture: an object's mesh, its pictures, and the texture that others made of
// them.
#pragma once

#include <array>
#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>

#include "depth_fusion/common/error.h"
#include "depth_fusion/texturing/texturing.h"
#include "support/file_bytes.h"

namespace depth_fusion {

constexpr int kBlosterViews = 14;

// An ASCII PLY file of triangles.
inline TriangleMesh readBlosterMesh(const std::string& folder) {
  std::ifstream file(folder + "/bloster.ply");
  check(file.is_open(), folder + "/bloster.ply cannot be opened");
  size_t vertices = 0, faces = 0;
  for (std::string line; std::getline(file, line) && line.rfind("end_header", 0) != 0;) {
    std::istringstream words(line);
    std::string element, name;
    words >> element >> name;
    if (name == "vertex") words >> vertices;
    if (name == "face") words >> faces;
  }
  TriangleMesh mesh;
  mesh.vertices.resize(vertices, {Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitZ()});
  for (MeshVertex& vertex : mesh.vertices)
    file >> vertex.position_W.x() >> vertex.position_W.y() >> vertex.position_W.z();
  mesh.triangles.resize(faces);
  for (MeshTriangle& t : mesh.triangles) {
    int corners = 0;
    file >> corners >> t[0] >> t[1] >> t[2];
    check(corners == 3 && static_cast<bool>(file), folder + "/bloster.ply has a face that is no triangle");
  }
  return mesh;
}

inline TexturingView readBlosterView(const std::string& folder, int number) {
  const std::string name = folder + "/color_" + (number < 10 ? "0" : "") + std::to_string(number);
  std::ifstream file(name + ".cam");
  Pose T_C_W = Pose::Identity();
  for (int i = 0; i < 3; ++i) file >> T_C_W.translation()[i];
  for (int i = 0; i < 9; ++i) file >> T_C_W.linear()(i / 3, i % 3);
  check(static_cast<bool>(file), name + ".cam cannot be read");
  return {fileBytes(name + ".jpg"),
          {1920, 1080, 1081.37, 1081.37, 959.5, 539.5},
          orthonormalized(T_C_W).inverse()};
}

// The OBJ file of the published result.
inline TexturedMesh readPublishedBloster(const std::string& folder) {
  TexturedMesh textured;
  std::ifstream file(folder + "/published/result.obj");
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector2f> shares;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      Eigen::Vector3f& p = positions.emplace_back();
      words >> p.x() >> p.y() >> p.z();
    } else if (kind == "vt") {
      Eigen::Vector2f& share = shares.emplace_back();
      words >> share.x() >> share.y();
    } else if (kind == "usemtl") {
      std::string material;
      words >> material;
      if (!textured.pages.empty()) textured.page_ends.push_back(textured.mesh.triangles.size());
      textured.pages.push_back(cv::imread(folder + "/published/result_" + material + "_map_Kd.png"));
    } else if (kind == "f") {
      const auto first = static_cast<uint32_t>(textured.mesh.vertices.size());
      for (int i = 0; i < 3; ++i) {
        size_t vertex = 0, share = 0, normal = 0;
        char slash = 0;
        words >> vertex >> slash >> share >> slash >> normal;
        const cv::Mat& page = textured.pages.back();
        textured.mesh.vertices.push_back({positions.at(vertex - 1), Eigen::Vector3f::UnitZ()});
        textured.places.emplace_back(
            shares.at(share - 1).x() * static_cast<float>(page.cols) - 0.5f,
            (1.0f - shares.at(share - 1).y()) * static_cast<float>(page.rows) - 0.5f);
      }
      textured.mesh.triangles.push_back({first, first + 1, first + 2});
    }
  }
  textured.page_ends.push_back(textured.mesh.triangles.size());
  return textured;
}

// The mesh with its vertices' colours, as fine as it is: those that a texture has there.
inline TriangleMesh coloredByTexture(const TriangleMesh& mesh, const TexturedMesh& textured) {
  std::map<std::array<float, 3>, MeshColor> colors;
  size_t page = 0;
  for (size_t face = 0; face < textured.mesh.triangles.size(); ++face) {
    while (face >= textured.page_ends[page]) ++page;
    for (const uint32_t vertex : textured.mesh.triangles[face]) {
      const Eigen::Vector3f& p = textured.mesh.vertices[vertex].position_W;
      const cv::Vec3b& bgr = textured.pages[page].at<cv::Vec3b>(cvRound(textured.places[vertex].y()),
                                                                cvRound(textured.places[vertex].x()));
      colors[{p.x(), p.y(), p.z()}] = {bgr[2], bgr[1], bgr[0]};
    }
  }
  TriangleMesh colored = mesh;
  for (const MeshVertex& vertex : mesh.vertices)
    colored.colors.push_back(colors[{vertex.position_W.x(), vertex.position_W.y(), vertex.position_W.z()}]);
  return colored;
}

}  // namespace depth_fusion
