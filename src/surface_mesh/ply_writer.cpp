#include <algorithm>
#include <string>

#include "depth_fusion/surface_mesh/ply.h"
#include "surface_mesh/whole_file.h"

namespace depth_fusion {
namespace {

constexpr size_t kColoredVertexBytes = sizeof(MeshVertex) + sizeof(MeshColor);
constexpr size_t kFaceBytes = 1 + sizeof(MeshTriangle);
constexpr size_t kFacesPerWrite = 16384;
constexpr unsigned char kCorners = 3;

// Puts the bytes of a value where `place` points, and returns the place behind them.
template <class Value>
unsigned char* put(const Value& value, unsigned char* place) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(&value);
  return std::copy(bytes, bytes + sizeof(Value), place);
}

std::string plyHeader(const MeshSize& size) {
  return "ply\nformat binary_little_endian 1.0\ncomment depth_fusion, metres\nelement vertex " +
         std::to_string(size.vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\n"
         "property float nx\nproperty float ny\nproperty float nz\n" +
         (size.colored ? "property uchar red\nproperty uchar green\nproperty uchar blue\n" : "") +
         "element face " + std::to_string(size.triangles) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

}  // namespace

PlyWriter::PlyWriter(const std::string& path) : file_(std::make_unique<WholeFile>(path)) {}

PlyWriter::~PlyWriter() = default;

void PlyWriter::begin(const MeshSize& size) {
  const std::string text = plyHeader(size);
  file_->writeAt(0, text.data(), text.size());
  vertex_offset_ = text.size();
  colored_ = size.colored;
  face_offset_ = vertex_offset_ + size.vertices * (colored_ ? kColoredVertexBytes : sizeof(MeshVertex));
}

void PlyWriter::addVertices(const MeshVertex* vertices, const MeshColor* colors, size_t count) {
  const void* data = vertices;
  size_t bytes = count * sizeof(MeshVertex);
  if (colored_) {
    bytes = count * kColoredVertexBytes;
    colored_vertices_.resize(bytes);
    unsigned char* next = colored_vertices_.data();
    for (size_t i = 0; i < count; ++i) next = put(colors[i], put(vertices[i], next));
    data = colored_vertices_.data();
  }
  file_->writeAt(vertex_offset_, data, bytes);
  vertex_offset_ += bytes;
}

void PlyWriter::addTriangles(const MeshTriangle* triangles, size_t count) {
  faces_.resize(kFacesPerWrite * kFaceBytes);
  while (count > 0) {
    const size_t batch = std::min(count, kFacesPerWrite);
    unsigned char* next = faces_.data();
    for (size_t i = 0; i < batch; ++i) next = put(triangles[i], put(kCorners, next));
    file_->writeAt(face_offset_, faces_.data(), batch * kFaceBytes);
    face_offset_ += batch * kFaceBytes;
    triangles += batch;
    count -= batch;
  }
}

void PlyWriter::finish() { file_->commit(); }

void writePly(const std::string& path, const TriangleMesh& mesh) {
  PlyWriter writer(path);
  sendMesh(mesh, writer);
}

}  // namespace depth_fusion
