#include <Eigen/Geometry>

#include "surface_mesh/glb_file.h"
#include "texturing/texture_pages.h"
#include "texturing/textured_mesh_writers.h"

namespace depth_fusion {
namespace {

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : ",") + text;
  return "[" + all + "]";
}

// The bytes of a .glb file, part after part, with the views and accessors that describe them.
struct GlbParts {
  std::string data;
  std::vector<std::string> views, accessors;

  template <class Item>
  void add(const Item* items, size_t count, int target) {
    const GlbPart part{data.size(), count * sizeof(Item), count};
    views.push_back(glbView(part, target));
    data.append(reinterpret_cast<const char*>(items), part.bytes);
    data.resize((data.size() + 3) / 4 * 4);
  }
  void describe(uint64_t count, int component, const char* type, const std::string& more = "") {
    accessors.push_back(glbAccessor(static_cast<int>(views.size()) - 1, count, component, type, more));
  }
};

void addVertices(const TexturedMesh& mesh, GlbParts& parts) {
  std::vector<Eigen::Vector3f> positions, normals;
  Eigen::AlignedBox3f box;
  for (const MeshVertex& vertex : mesh.mesh.vertices) {
    positions.push_back(vertex.position_W);
    normals.push_back(vertex.normal_W);
    box.extend(vertex.position_W);
  }
  const std::vector<Eigen::Vector2f> shares = sharesOf(mesh);
  parts.add(positions.data(), positions.size(), kGlbVertexData);
  parts.describe(positions.size(), kGlbFloat, "VEC3", glbBounds(box));
  parts.add(normals.data(), normals.size(), kGlbVertexData);
  parts.describe(normals.size(), kGlbFloat, "VEC3");
  parts.add(shares.data(), shares.size(), kGlbVertexData);
  parts.describe(shares.size(), kGlbFloat, "VEC2");
}

}  // namespace

void writeTexturedGlb(const std::string& path, const TexturedMesh& mesh, UpAxis up) {
  GlbFile file(path);
  GlbParts parts;
  addVertices(mesh, parts);
  std::vector<std::string> primitives, materials, textures, images;
  for (size_t page = 0, begin = 0; page < mesh.pages.size(); begin = mesh.page_ends[page++]) {
    const std::string number = std::to_string(page);
    const size_t count = mesh.page_ends[page] - begin;
    parts.add(mesh.mesh.triangles.data() + begin, count, kGlbIndexData);
    parts.describe(3 * count, kGlbUint32, "SCALAR");
    primitives.push_back(R"({"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":)" +
                         std::to_string(parts.accessors.size() - 1) + R"(,"material":)" + number + "}");
    const std::string picture = encodedPage(mesh.pages[page]);
    parts.add(picture.data(), picture.size(), 0);
    images.push_back(R"({"mimeType":"image/png","bufferView":)" + std::to_string(parts.views.size() - 1) +
                     "}");
    textures.push_back(R"({"source":)" + number + "}");
    materials.push_back(R"({"doubleSided":true,"pbrMetallicRoughness":{"metallicFactor":0,)"
                        R"("baseColorTexture":{"index":)" +
                        number + R"(}},"extensions":{"KHR_materials_unlit":{}}})");
  }
  const std::string text =
      "{" + glbHead(up) + R"(,"extensionsUsed":["KHR_materials_unlit"],"meshes":[{"primitives":)" +
      joined(primitives) + R"(}],"materials":)" + joined(materials) + R"(,"textures":)" + joined(textures) +
      R"(,"images":)" + joined(images) + "," + glbBuffer(parts.data.size()) + R"(,"bufferViews":)" +
      joined(parts.views) + R"(,"accessors":)" + joined(parts.accessors) + "}";
  file.begin(text.size(), parts.data.size());
  file.write(0, parts.data.data(), parts.data.size());
  file.finish(text);
}

}  // namespace depth_fusion
