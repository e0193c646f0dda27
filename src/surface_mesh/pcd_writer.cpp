#include "surface_mesh/pcd_writer.h"

#include <cstring>

namespace depth_fusion {
namespace {

std::string pcdHeader(const MeshSize& size) {
  const std::string points = std::to_string(size.vertices);
  return "# .PCD v0.7 - depth_fusion, metres\nVERSION 0.7\nFIELDS x y z normal_x normal_y normal_z" +
         std::string(size.colored ? " rgb" : "") + "\nSIZE 4 4 4 4 4 4" + (size.colored ? " 4" : "") +
         "\nTYPE F F F F F F" + (size.colored ? " F" : "") + "\nCOUNT 1 1 1 1 1 1" +
         (size.colored ? " 1" : "") + "\nWIDTH " + points + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
         points + "\nDATA binary\n";
}

}  // namespace

void PcdWriter::begin(const MeshSize& size) {
  const std::string text = pcdHeader(size);
  file_.writeAt(0, text.data(), text.size());
  offset_ = text.size();
}

void PcdWriter::addVertices(const MeshVertex* vertices, const MeshColor* colors, size_t count) {
  const size_t point_bytes = sizeof(MeshVertex) + (colors == nullptr ? 0 : sizeof(uint32_t));
  points_.resize(count * point_bytes);
  for (size_t i = 0; i < count; ++i) {
    unsigned char* point = &points_[i * point_bytes];
    std::memcpy(point, &vertices[i], sizeof(MeshVertex));
    if (colors == nullptr) continue;
    const uint32_t rgb = uint32_t{colors[i][0]} << 16 | uint32_t{colors[i][1]} << 8 | colors[i][2];
    std::memcpy(point + sizeof(MeshVertex), &rgb, sizeof(rgb));
  }
  file_.writeAt(offset_, points_.data(), points_.size());
  offset_ += points_.size();
}

}  // namespace depth_fusion
