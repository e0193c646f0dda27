#include "surface_mesh/glb_writer.h"

namespace depth_fusion {
namespace {

constexpr uint64_t kTextBytes = 2048;
constexpr uint64_t kVectorBytes = sizeof(Eigen::Vector3f);
constexpr uint64_t kLinearColorBytes = sizeof(std::array<uint16_t, 4>);

GlbPart partBehind(const GlbPart& part, uint64_t count, uint64_t bytes_each) {
  return {part.offset + part.bytes, count * bytes_each, count};
}

}  // namespace

void GlbWriter::begin(const MeshSize& size) {
  size_ = size;
  vertices_ = triangles_ = 0;
  box_.setEmpty();
  positions_ = partBehind({}, size.vertices, kVectorBytes);
  normals_ = partBehind(positions_, size.vertices, kVectorBytes);
  colors_ = partBehind(normals_, size.colored ? size.vertices : 0, kLinearColorBytes);
  indices_ = partBehind(colors_, 3 * size.triangles, sizeof(uint32_t));
  file_.begin(kTextBytes, size.triangles == 0 ? 0 : indices_.offset + indices_.bytes);
}

void GlbWriter::addVertices(const MeshVertex* vertices, const MeshColor* colors, size_t count) {
  if (size_.triangles == 0) return;
  std::vector<Eigen::Vector3f> vectors(count);
  for (size_t i = 0; i < count; ++i) box_.extend(vectors[i] = vertices[i].position_W);
  file_.write(positions_.offset + vertices_ * kVectorBytes, vectors.data(), count * kVectorBytes);
  for (size_t i = 0; i < count; ++i) vectors[i] = vertices[i].normal_W;
  file_.write(normals_.offset + vertices_ * kVectorBytes, vectors.data(), count * kVectorBytes);
  if (size_.colored) {
    std::vector<std::array<uint16_t, 4>> linear(count);
    for (size_t i = 0; i < count; ++i) linear[i] = linearColor(colors[i]);
    file_.write(colors_.offset + vertices_ * kLinearColorBytes, linear.data(), count * kLinearColorBytes);
  }
  vertices_ += count;
}

void GlbWriter::addTriangles(const MeshTriangle* triangles, size_t count) {
  file_.write(indices_.offset + triangles_ * sizeof(MeshTriangle), triangles, count * sizeof(MeshTriangle));
  triangles_ += count;
}

void GlbWriter::finish() {
  file_.finish(size_.triangles == 0 ? R"({"asset":{"version":"2.0"}})" : description());
}

std::string GlbWriter::description() const {
  const bool colored = size_.colored;
  const std::string material =
      colored ? R"("extensionsUsed":["KHR_materials_unlit"],"materials":[{"doubleSided":true,)"
                R"("pbrMetallicRoughness":{"metallicFactor":0},"extensions":{"KHR_materials_unlit":{}}}])"
              : R"("materials":[{"doubleSided":true,"pbrMetallicRoughness":{"metallicFactor":0}}])";
  const std::string indices_view = colored ? "3" : "2";
  return "{" + glbHead(up_) +
         R"(,"meshes":[{"primitives":[{"material":0,"attributes":{"POSITION":0,"NORMAL":1)" +
         (colored ? R"(,"COLOR_0":2)" : "") + R"(},"indices":)" + indices_view + "}]}]," + material + "," +
         glbBuffer(indices_.offset + indices_.bytes) + R"(,"bufferViews":[)" +
         glbView(positions_, kGlbVertexData) + "," + glbView(normals_, kGlbVertexData) + "," +
         (colored ? glbView(colors_, kGlbVertexData) + "," : "") + glbView(indices_, kGlbIndexData) +
         R"(],"accessors":[)" + glbAccessor(0, positions_.count, kGlbFloat, "VEC3", glbBounds(box_)) + "," +
         glbAccessor(1, normals_.count, kGlbFloat, "VEC3") + "," +
         (colored ? glbAccessor(2, colors_.count, kGlbUint16, "VEC4", R"(,"normalized":true)") + "," : "") +
         glbAccessor(colored ? 3 : 2, indices_.count, kGlbUint32, "SCALAR") + "]}";
}

}  // namespace depth_fusion
