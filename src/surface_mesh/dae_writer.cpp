#include "surface_mesh/dae_writer.h"

#include <algorithm>
#include <cstdio>

namespace depth_fusion {
namespace {

constexpr size_t kItemsPerWrite = 16384;
// A float has nine digits, and room for sign, point, exponent and a blank; normals and colours lie between -1
// and 1 and have five decimals.
constexpr size_t kPositionTextBytes = 3 * 16 + 1, kDecimalsBytes = 3 * 9 + 1;

void appendPosition(std::string& text, const Eigen::Vector3f& p) {
  char line[kPositionTextBytes + 1];
  std::snprintf(line, sizeof(line), "%16.9g%16.9g%16.9g\n", static_cast<double>(p.x()),
                static_cast<double>(p.y()), static_cast<double>(p.z()));
  text += line;
}

void appendDecimals(std::string& text, double x, double y, double z) {
  char line[kDecimalsBytes + 1];
  std::snprintf(line, sizeof(line), "%9.5f%9.5f%9.5f\n", x, y, z);
  text += line;
}

std::string head(UpAxis up) {
  return std::string(
             "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
             "<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">\n"
             "<asset><contributor><authoring_tool>depth_fusion</authoring_tool></contributor>"
             "<created>2000-01-01T00:00:00Z</created><modified>2000-01-01T00:00:00Z</modified>"
             "<unit name=\"meter\" meter=\"1\"/><up_axis>") +
         (up == UpAxis::kZ ? "Z_UP" : "Y_UP") +
         "</up_axis></asset>\n<library_geometries><geometry id=\"surface\" name=\"surface\"><mesh>\n";
}

std::string tail(UpAxis up) {
  return std::string(
             "</p></triangles></mesh></geometry></library_geometries>\n"
             "<library_visual_scenes><visual_scene id=\"scene\"><node id=\"map\">") +
         (up == UpAxis::kZ ? "" : "<rotate>1 0 0 180</rotate>") +
         "<instance_geometry url=\"#surface\"/></node></visual_scene></library_visual_scenes>\n"
         "<scene><instance_visual_scene url=\"#scene\"/></scene>\n</COLLADA>\n";
}

std::string input(const std::string& semantic, const std::string& source) {
  return "<input semantic=\"" + semantic + "\" source=\"#" + source + "\"/>";
}

std::string sourceEnd(const std::string& name, const std::string& axes, uint64_t count) {
  std::string text = "</float_array><technique_common><accessor source=\"#" + name + "-numbers\" count=\"" +
                     std::to_string(count) + "\" stride=\"3\">";
  for (const char axis : axes) text += std::string("<param name=\"") + axis + "\" type=\"float\"/>";
  return text + "</accessor></technique_common></source>\n";
}

std::string verticesAndTriangles(const MeshSize& size) {
  return "<vertices id=\"vertices\">" + input("POSITION", "positions") + input("NORMAL", "normals") +
         (size.colored ? input("COLOR", "colors") : "") + "</vertices>\n<triangles count=\"" +
         std::to_string(size.triangles) +
         "\"><input semantic=\"VERTEX\" source=\"#vertices\" offset=\"0\"/><p>\n";
}

}  // namespace

void DaeWriter::begin(const MeshSize& size) {
  index_width_ = static_cast<int>(std::to_string(size.vertices).size());
  uint64_t offset = 0;
  write(offset, head(up_));
  positions_ = writeSource(offset, "positions", "XYZ", size.vertices, kPositionTextBytes);
  normals_ = writeSource(offset, "normals", "XYZ", size.vertices, kDecimalsBytes);
  if (size.colored) colors_ = writeSource(offset, "colors", "RGB", size.vertices, kDecimalsBytes);
  write(offset, verticesAndTriangles(size));
  faces_ = offset;
  offset += size.triangles * 3 * (static_cast<uint64_t>(index_width_) + 1);
  write(offset, tail(up_));
}

void DaeWriter::addVertices(const MeshVertex* vertices, const MeshColor* colors, size_t count) {
  for (size_t begin = 0; begin < count; begin += kItemsPerWrite) {
    std::string positions, normals, rgb;
    for (size_t i = begin; i < std::min(begin + kItemsPerWrite, count); ++i) {
      const Eigen::Vector3d n = vertices[i].normal_W.cast<double>();
      appendPosition(positions, vertices[i].position_W);
      appendDecimals(normals, n.x(), n.y(), n.z());
      if (colors != nullptr)
        appendDecimals(rgb, colors[i][0] / 255.0, colors[i][1] / 255.0, colors[i][2] / 255.0);
    }
    write(positions_, positions);
    write(normals_, normals);
    write(colors_, rgb);
  }
}

void DaeWriter::addTriangles(const MeshTriangle* triangles, size_t count) {
  char line[64];
  for (size_t begin = 0; begin < count; begin += kItemsPerWrite) {
    std::string faces;
    for (size_t i = begin; i < std::min(begin + kItemsPerWrite, count); ++i) {
      const MeshTriangle& t = triangles[i];
      std::snprintf(line, sizeof(line), "%*u %*u %*u\n", index_width_, t[0], index_width_, t[1], index_width_,
                    t[2]);
      faces += line;
    }
    write(faces_, faces);
  }
}

void DaeWriter::write(uint64_t& offset, const std::string& text) {
  file_.writeAt(offset, text.data(), text.size());
  offset += text.size();
}

uint64_t DaeWriter::writeSource(uint64_t& offset, const std::string& name, const std::string& axes,
                                uint64_t count, uint64_t bytes_each) {
  write(offset, "<source id=\"" + name + "\"><float_array id=\"" + name + "-numbers\" count=\"" +
                    std::to_string(3 * count) + "\">\n");
  const uint64_t numbers = offset;
  offset += count * bytes_each;
  write(offset, sourceEnd(name, axes, count));
  return numbers;
}

}  // namespace depth_fusion
