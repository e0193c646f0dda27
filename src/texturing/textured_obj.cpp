#include <filesystem>

#include "texturing/texture_pages.h"
#include "texturing/textured_mesh_writers.h"

namespace depth_fusion {
namespace {

void writeVertices(const TexturedMesh& mesh, GrowingFile& obj) {
  const std::vector<Eigen::Vector2f> shares = sharesOf(mesh);
  for (size_t i = 0; i < mesh.places.size(); ++i) {
    const Eigen::Vector3d p = mesh.mesh.vertices[i].position_W.cast<double>();
    const Eigen::Vector3d n = mesh.mesh.vertices[i].normal_W.cast<double>();
    obj.print("v %.9g %.9g %.9g\nvn %.5f %.5f %.5f\n", p.x(), p.y(), p.z(), n.x(), n.y(), n.z());
    obj.print("vt %.8f %.8f\n", static_cast<double>(shares[i].x()), 1.0 - static_cast<double>(shares[i].y()));
  }
}

void addFaces(const TexturedMesh& mesh, GrowingFile& obj) {
  size_t face = 0;
  for (size_t page = 0; page < mesh.pages.size(); ++page) {
    obj.print("usemtl page_%zu\n", page);
    for (; face < mesh.page_ends[page]; ++face) {
      const MeshTriangle& t = mesh.mesh.triangles[face];
      const uint32_t a = t[0] + 1, b = t[1] + 1, c = t[2] + 1;
      obj.print("f %u/%u/%u %u/%u/%u %u/%u/%u\n", a, a, a, b, b, b, c, c, c);
    }
  }
}

}  // namespace

void writeTexturedObj(const std::string& path, const TexturedMesh& mesh) {
  const std::filesystem::path material_path = std::filesystem::path(path).replace_extension(".mtl");
  GrowingFile obj(path), materials(material_path.string());
  PageFiles pages(path, mesh.pages);
  for (size_t i = 0; i < mesh.pages.size(); ++i)
    materials.add("newmtl page_" + std::to_string(i) + "\nKa 1 1 1\nKd 1 1 1\nKs 0 0 0\nillum 0\nmap_Kd " +
                  pages.names()[i] + "\n");
  obj.add("# depth_fusion, metres\nmtllib " + material_path.filename().string() + "\n");
  writeVertices(mesh, obj);
  addFaces(mesh, obj);
  pages.commit();
  materials.commit();
  obj.commit();
}

}  // namespace depth_fusion
