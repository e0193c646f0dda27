#include "texturing/texture_pages.h"
#include "texturing/textured_mesh_writers.h"

namespace depth_fusion {
namespace {

template <class Value>
void put(const Value& value, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(Value));
}

// As MeshLab has it: the files by comments, of each face the places of its corners, and the file's number.
std::string header(const TexturedMesh& mesh, const std::vector<std::string>& pages) {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment depth_fusion, metres\n";
  for (const std::string& page : pages) text += "comment TextureFile " + page + "\n";
  text += "element vertex " + std::to_string(mesh.mesh.vertices.size()) +
          "\nproperty float x\nproperty float y\nproperty float z\n"
          "property float nx\nproperty float ny\nproperty float nz\n"
          "element face " +
          std::to_string(mesh.mesh.triangles.size()) +
          "\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
          "property int texnumber\nend_header\n";
  return text;
}

}  // namespace

void writeTexturedPly(const std::string& path, const TexturedMesh& mesh) {
  constexpr unsigned char kCorners = 3, kNumbers = 6;
  GrowingFile ply(path);
  PageFiles pages(path, mesh.pages);
  ply.add(header(mesh, pages.names()));
  for (const MeshVertex& vertex : mesh.mesh.vertices) {
    std::string bytes;
    put(vertex, bytes);
    ply.add(bytes);
  }
  const std::vector<Eigen::Vector2f> shares = sharesOf(mesh);
  size_t face = 0;
  for (size_t page = 0; page < mesh.pages.size(); ++page) {
    for (; face < mesh.page_ends[page]; ++face) {
      std::string bytes;
      put(kCorners, bytes);
      put(mesh.mesh.triangles[face], bytes);
      put(kNumbers, bytes);
      for (const uint32_t vertex : mesh.mesh.triangles[face]) {
        put(shares[vertex].x(), bytes);
        put(1.0f - shares[vertex].y(), bytes);
      }
      put(static_cast<int32_t>(page), bytes);
      ply.add(bytes);
    }
  }
  pages.commit();
  ply.commit();
}

}  // namespace depth_fusion
