#include "apps/view/obj_file.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

// "x y z", and "red green blue" from 0 to 1 where the file has colours.
void addVertex(std::istringstream& line, TriangleMesh& mesh) {
  Eigen::Vector3f p_W, color;
  line >> p_W.x() >> p_W.y() >> p_W.z();
  mesh.vertices.push_back({p_W, Eigen::Vector3f::Zero()});
  if (!(line >> color.x() >> color.y() >> color.z())) return;
  MeshColor bytes;
  for (int i = 0; i < 3; ++i)
    bytes[static_cast<size_t>(i)] =
        static_cast<uint8_t>(std::lround(255.0f * std::clamp(color[i], 0.0f, 1.0f)));
  mesh.colors.push_back(bytes);
}

// Numbers of vertices from 1 on, or from the last one back, each with what follows a slash.
void addFace(std::istringstream& line, const std::string& path, TriangleMesh& mesh) {
  const auto count = static_cast<int64_t>(mesh.vertices.size());
  std::vector<uint32_t> corners;
  for (std::string corner; line >> corner;) {
    const int64_t number = std::strtoll(corner.c_str(), nullptr, 10);
    const int64_t index = number < 0 ? count + number : number - 1;
    check(index >= 0 && index < count, path + ": a face names vertex " + corner + ", which is not there");
    corners.push_back(static_cast<uint32_t>(index));
  }
  for (size_t i = 2; i < corners.size(); ++i)
    mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
}

}  // namespace

TriangleMesh readObj(const std::string& path) {
  std::ifstream file(path);
  check(file.good(), path + " cannot be read; is it there?");
  TriangleMesh mesh;
  for (std::string text; std::getline(file, text);) {
    std::istringstream line(text);
    std::string kind;
    line >> kind;
    if (kind == "v") addVertex(line, mesh);
    if (kind == "f") addFace(line, path, mesh);
  }
  if (mesh.colors.size() != mesh.vertices.size()) mesh.colors.clear();
  setNormals(mesh);
  return mesh;
}

void setNormals(TriangleMesh& mesh) {
  for (const MeshTriangle& t : mesh.triangles) {
    const Eigen::Vector3f a = mesh.vertices[t[0]].position_W;
    const Eigen::Vector3f normal =
        (mesh.vertices[t[1]].position_W - a).cross(mesh.vertices[t[2]].position_W - a);
    for (const uint32_t vertex : t) mesh.vertices[vertex].normal_W += normal;
  }
  for (MeshVertex& vertex : mesh.vertices) vertex.normal_W.normalize();
}

}  // namespace depth_fusion
