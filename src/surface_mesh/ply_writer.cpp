#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "depth_fusion/common/error.h"
#include "depth_fusion/surface_mesh/ply.h"

namespace depth_fusion {
namespace {

constexpr size_t kColoredVertexBytes = sizeof(MeshVertex) + sizeof(MeshColor);
constexpr size_t kFaceBytes = 1 + sizeof(MeshTriangle);
constexpr size_t kFacesPerWrite = 16384;
constexpr unsigned char kCorners = 3;

std::string header(const MeshSize& size) {
  return "ply\nformat binary_little_endian 1.0\ncomment depth_fusion, metres\nelement vertex " +
         std::to_string(size.vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\n"
         "property float nx\nproperty float ny\nproperty float nz\n" +
         (size.colored ? "property uchar red\nproperty uchar green\nproperty uchar blue\n" : "") +
         "element face " + std::to_string(size.triangles) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

// Devices and pipes are not ours to remove.
void removeRegularFile(const std::string& path) {
  struct stat status {};
  if (lstat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode)) unlink(path.c_str());
}

}  // namespace

PlyWriter::PlyWriter(const std::string& path)
    : path_(path), file_(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
  if (file_ < 0) fail("cannot be created");
}

PlyWriter::~PlyWriter() {
  if (file_ < 0) return;
  close(file_);
  removeRegularFile(path_);
}

void PlyWriter::begin(const MeshSize& size) {
  const std::string text = header(size);
  writeAt(0, text.data(), text.size());
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
    for (size_t i = 0; i < count; ++i, next += kColoredVertexBytes) {
      std::memcpy(next, &vertices[i], sizeof(MeshVertex));
      std::memcpy(next + sizeof(MeshVertex), &colors[i], sizeof(MeshColor));
    }
    data = colored_vertices_.data();
  }
  writeAt(vertex_offset_, data, bytes);
  vertex_offset_ += bytes;
}

void PlyWriter::addTriangles(const MeshTriangle* triangles, size_t count) {
  faces_.resize(kFacesPerWrite * kFaceBytes);
  while (count > 0) {
    const size_t batch = std::min(count, kFacesPerWrite);
    for (size_t i = 0; i < batch; ++i) {
      faces_[i * kFaceBytes] = kCorners;
      std::memcpy(&faces_[i * kFaceBytes + 1], &triangles[i], sizeof(MeshTriangle));
    }
    writeAt(face_offset_, faces_.data(), batch * kFaceBytes);
    face_offset_ += batch * kFaceBytes;
    triangles += batch;
    count -= batch;
  }
}

void PlyWriter::finish() {
  const int file = file_;
  file_ = -1;
  if (close(file) == 0) return;
  const int reason = errno;
  removeRegularFile(path_);
  errno = reason;
  fail("cannot be written");
}

void PlyWriter::writeAt(uint64_t offset, const void* data, size_t bytes) {
  const char* next = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t written = pwrite(file_, next, bytes, static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("cannot be written");
    next += written;
    offset += static_cast<uint64_t>(written);
    bytes -= static_cast<size_t>(written);
  }
}

void PlyWriter::fail(const std::string& action) const {
  throw Error("mesh file " + path_ + " " + action + ": " + std::strerror(errno));
}

void writePly(const std::string& path, const TriangleMesh& mesh) {
  PlyWriter writer(path);
  const bool colored = !mesh.colors.empty();
  writer.begin({mesh.vertices.size(), mesh.triangles.size(), colored});
  writer.addVertices(mesh.vertices.data(), colored ? mesh.colors.data() : nullptr, mesh.vertices.size());
  writer.addTriangles(mesh.triangles.data(), mesh.triangles.size());
  writer.finish();
}

}  // namespace depth_fusion
