#include <Eigen/Geometry>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <opencv2/imgcodecs.hpp>

#include "depth_fusion/common/error.h"
#include "depth_fusion/texturing/textured_mesh.h"
#include "surface_mesh/glb_file.h"
#include "surface_mesh/whole_file.h"

namespace depth_fusion {
namespace {

std::string encoded(const cv::Mat& page) {
  std::vector<unsigned char> bytes;
  check(cv::imencode(".png", page, bytes), "a page of the texture cannot be encoded");
  return {bytes.begin(), bytes.end()};
}

// The place as a share of the page, from its top left corner on.
Eigen::Vector2f shareOf(const Eigen::Vector2f& place, const cv::Mat& page) {
  return {(place.x() + 0.5f) / static_cast<float>(page.cols),
          (place.y() + 0.5f) / static_cast<float>(page.rows)};
}

// The shares of all vertices; each lies in one page.
std::vector<Eigen::Vector2f> sharesOf(const TexturedMesh& mesh) {
  std::vector<Eigen::Vector2f> shares(mesh.places.size());
  size_t face = 0;
  for (size_t page = 0; page < mesh.pages.size(); ++page) {
    for (; face < mesh.page_ends[page]; ++face) {
      for (const uint32_t vertex : mesh.mesh.triangles[face])
        shares[vertex] = shareOf(mesh.places[vertex], mesh.pages[page]);
    }
  }
  return shares;
}

// A file that is written in one piece, and appears with commit().
class TextFile {
 public:
  explicit TextFile(const std::string& path) : file_(path) {}
  template <class... Values>
  void print(const char* format, Values... values) {
    char line[256];
    const int length = std::snprintf(line, sizeof(line), format, values...);
    add({line, static_cast<size_t>(length)});
  }
  void add(const std::string& text) {
    text_ += text;
    constexpr size_t kFlushBytes = size_t{1} << 20;
    if (text_.size() > kFlushBytes) flush();
  }
  void commit() {
    flush();
    file_.commit();
  }

 private:
  void flush() {
    file_.writeAt(offset_, text_.data(), text_.size());
    offset_ += text_.size();
    text_.clear();
  }

  WholeFile file_;
  std::string text_;
  uint64_t offset_ = 0;
};

void addObj(TextFile& obj, const TexturedMesh& mesh, const std::string& material_file) {
  obj.add("# depth_fusion, metres\nmtllib " + material_file + "\n");
  const std::vector<Eigen::Vector2f> shares = sharesOf(mesh);
  for (size_t i = 0; i < mesh.places.size(); ++i) {
    const Eigen::Vector3d p = mesh.mesh.vertices[i].position_W.cast<double>();
    const Eigen::Vector3d n = mesh.mesh.vertices[i].normal_W.cast<double>();
    obj.print("v %.9g %.9g %.9g\nvn %.5f %.5f %.5f\n", p.x(), p.y(), p.z(), n.x(), n.y(), n.z());
    obj.print("vt %.8f %.8f\n", static_cast<double>(shares[i].x()), 1.0 - static_cast<double>(shares[i].y()));
  }
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

void writeObj(const std::string& path, const TexturedMesh& mesh) {
  const std::string stem = std::filesystem::path(path).replace_extension().string();
  const std::string name = std::filesystem::path(stem).filename().string();
  TextFile obj(path), materials(stem + ".mtl");
  std::vector<std::unique_ptr<TextFile>> pages;
  for (size_t i = 0; i < mesh.pages.size(); ++i) {
    const std::string number = std::to_string(i);
    materials.add("newmtl page_" + number + "\nKa 1 1 1\nKd 1 1 1\nKs 0 0 0\nillum 0\nmap_Kd " + name + "_" +
                  number + ".png\n");
    pages.push_back(std::make_unique<TextFile>(stem + "_" + number + ".png"));
    pages.back()->add(encoded(mesh.pages[i]));
  }
  addObj(obj, mesh, name + ".mtl");
  for (const auto& page : pages) page->commit();
  materials.commit();
  obj.commit();
}

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

void writeGlb(const std::string& path, const TexturedMesh& mesh, UpAxis up) {
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
    const std::string picture = encoded(mesh.pages[page]);
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

}  // namespace

void checkTexturedPath(const std::string& path) {
  const std::string format = endingOf(path);
  check(format == "obj" || format == "glb", "textured mesh " + path + ": its name must end in .obj or .glb");
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  check(folder.empty() || std::filesystem::is_directory(folder),
        "textured mesh " + path + ": the folder " + folder.string() + " does not exist");
}

void writeTexturedMesh(const std::string& path, const TexturedMesh& mesh, UpAxis up) {
  checkTexturedPath(path);
  if (endingOf(path) == "glb") {
    writeGlb(path, mesh, up);
  } else {
    writeObj(path, mesh);
  }
}

}  // namespace depth_fusion
