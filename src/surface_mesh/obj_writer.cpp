#include "surface_mesh/obj_writer.h"

#include <iomanip>

namespace depth_fusion {
namespace {

constexpr std::streamoff kFlushBytes = std::streamoff{1} << 20;

// A float has nine digits; the width also holds sign, point, exponent and a blank.
constexpr int kFloatDigits = 9;
constexpr int kFloatWidth = 16;
// Colours and normals lie between -1 and 1: they have so many decimals, and the width holds a blank, too.
constexpr int kDecimals = 5;
constexpr int kDecimalsWidth = 9;

constexpr uint64_t vertexBytes(bool colored) {
  const uint64_t position = 1 + 3 * kFloatWidth + (colored ? 3 * kDecimalsWidth : 0) + 1;
  const uint64_t normal = 2 + 3 * kDecimalsWidth + 1;
  return position + normal;
}

std::ostream& setFloat(std::ostream& text) {
  return text << std::setw(kFloatWidth) << std::setprecision(kFloatDigits) << std::defaultfloat;
}

std::ostream& setDecimals(std::ostream& text) {
  return text << std::setw(kDecimalsWidth) << std::setprecision(kDecimals) << std::fixed;
}

}  // namespace

ObjWriter::ObjWriter(const std::string& path) : file_(path) { text_.imbue(std::locale::classic()); }

void ObjWriter::begin(const MeshSize& size) {
  index_width_ = static_cast<int>(std::to_string(size.vertices).size());
  text_ << "# depth_fusion, metres\n";
  flush(vertex_offset_);
  face_offset_ = vertex_offset_ + size.vertices * vertexBytes(size.colored);
}

void ObjWriter::addVertices(const MeshVertex* vertices, const MeshColor* colors, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    text_ << 'v';
    for (const float coordinate : vertices[i].position_W) text_ << setFloat << coordinate;
    if (colors != nullptr) {
      for (const uint8_t channel : colors[i]) text_ << setDecimals << channel / 255.0;
    }
    text_ << "\nvn";
    for (const float coordinate : vertices[i].normal_W) text_ << setDecimals << coordinate;
    text_ << '\n';
    if (text_.tellp() > kFlushBytes) flush(vertex_offset_);
  }
  flush(vertex_offset_);
}

void ObjWriter::addTriangles(const MeshTriangle* triangles, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    text_ << 'f';
    for (const uint32_t vertex : triangles[i]) {
      text_ << ' ' << std::right << std::setw(index_width_) << vertex + 1 << "//" << std::left
            << std::setw(index_width_) << vertex + 1;
    }
    text_ << std::right << '\n';
    if (text_.tellp() > kFlushBytes) flush(face_offset_);
  }
  flush(face_offset_);
}

void ObjWriter::flush(uint64_t& offset) {
  const std::string text = text_.str();
  file_.writeAt(offset, text.data(), text.size());
  offset += text.size();
  text_.str("");
}

}  // namespace depth_fusion
