#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>

#include "depth_fusion/common/error.h"
#include "depth_fusion/surface_mesh/ply.h"

namespace depth_fusion {
namespace {

constexpr size_t kVerticesPerRead = 65536;
constexpr int kAbsent = -1;

struct PlyHeader {
  MeshSize size;
  size_t vertex_bytes = 0;
  std::array<int, 6> offsets;        // of x y z nx ny nz in a vertex, or kAbsent
  std::array<int, 3> color_offsets;  // of red green blue, or kAbsent
};

class PlyFile {
 public:
  explicit PlyFile(const std::string& path) : path_(path), stream_(path, std::ios::binary) {
    require(stream_.is_open(), std::string("cannot be opened: ") + std::strerror(errno));
  }

  void require(bool condition, const std::string& problem) const {
    check(condition, "mesh file " + path_ + " " + problem);
  }

  std::string line() {
    std::string text;
    require(static_cast<bool>(std::getline(stream_, text)), "ends within its header");
    if (!text.empty() && text.back() == '\r') text.pop_back();
    return text;
  }

  void read(void* destination, size_t bytes) {
    stream_.read(static_cast<char*>(destination), static_cast<std::streamsize>(bytes));
    require(static_cast<bool>(stream_), "ends before its last vertex or face");
  }

  // A wrong count in the header must not ask for memory that the file cannot fill.
  void requireBytesLeft(uint64_t bytes) {
    const auto here = stream_.tellg();
    stream_.seekg(0, std::ios::end);
    require(static_cast<uint64_t>(stream_.tellg() - here) >= bytes, "ends before its last vertex or face");
    stream_.seekg(here);
  }

 private:
  std::string path_;
  std::ifstream stream_;
};

size_t bytesOfType(const std::string& type) {
  static const std::map<std::string, size_t> bytes = {
      {"char", 1},  {"uchar", 1},   {"int8", 1},   {"uint8", 1},  {"short", 2}, {"ushort", 2},
      {"int16", 2}, {"uint16", 2},  {"int", 4},    {"uint", 4},   {"int32", 4}, {"uint32", 4},
      {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
  const auto found = bytes.find(type);
  return found == bytes.end() ? 0 : found->second;
}

void readVertexProperty(const PlyFile& file, std::istringstream& words, PlyHeader& header) {
  static const std::array<std::string, 6> kNames = {"x", "y", "z", "nx", "ny", "nz"};
  static const std::array<std::string, 3> kColorNames = {"red", "green", "blue"};
  std::string type;
  std::string name;
  words >> type >> name;
  file.require(bytesOfType(type) > 0,
               "has a vertex property of type '" + type + "'; numbers only can be read");
  const auto wanted = std::find(kNames.begin(), kNames.end(), name);
  if (wanted != kNames.end()) {
    file.require(bytesOfType(type) == sizeof(float),
                 "has '" + name + "' as " + type + "; only float can be read");
    header.offsets[wanted - kNames.begin()] = static_cast<int>(header.vertex_bytes);
  }
  const auto color = std::find(kColorNames.begin(), kColorNames.end(), name);
  if (color != kColorNames.end() && (type == "uchar" || type == "uint8")) {
    header.color_offsets[color - kColorNames.begin()] = static_cast<int>(header.vertex_bytes);
  }
  header.vertex_bytes += bytesOfType(type);
}

void readFaceProperty(const PlyFile& file, std::istringstream& words) {
  std::string list;
  std::string count_type;
  std::string index_type;
  words >> list >> count_type >> index_type;
  file.require(list == "list" && bytesOfType(count_type) == 1 && bytesOfType(index_type) == 4,
               "has faces other than `list uchar int`");
}

void checkHeader(const PlyFile& file, const PlyHeader& header) {
  file.require(std::count(header.offsets.begin(), header.offsets.begin() + 3, kAbsent) == 0,
               "has vertices without x, y, z");
  const auto normals = std::count(header.offsets.begin() + 3, header.offsets.end(), kAbsent);
  file.require(normals == 0 || normals == 3, "has vertices with a part of a normal");
}

PlyHeader readHeader(PlyFile& file) {
  PlyHeader header;
  header.offsets.fill(kAbsent);
  header.color_offsets.fill(kAbsent);
  file.require(file.line() == "ply", "is no PLY file");
  std::string element;
  for (std::string line = file.line(); line != "end_header"; line = file.line()) {
    std::istringstream words(line);
    std::string keyword;
    words >> keyword;
    if (keyword == "format") {
      file.require(line == "format binary_little_endian 1.0",
                   "has '" + line + "'; only binary_little_endian can be read");
    } else if (keyword == "element") {
      words >> element;
      file.require(element == "vertex" || element == "face",
                   "has elements '" + element + "'; only vertex and face can be read");
      file.require(
          static_cast<bool>(words >> (element == "vertex" ? header.size.vertices : header.size.triangles)),
          "has no number in '" + line + "'");
    } else if (keyword == "property" && element == "vertex") {
      readVertexProperty(file, words, header);
    } else if (keyword == "property") {
      readFaceProperty(file, words);
    }
  }
  checkHeader(file, header);
  const auto& color = header.color_offsets;
  header.size.colored = std::count(color.begin(), color.end(), kAbsent) == 0;
  return header;
}

MeshVertex vertexFrom(const char* bytes, const std::array<int, 6>& offsets) {
  float numbers[6] = {};
  for (int i = 0; i < 6; ++i) {
    if (offsets[i] != kAbsent) std::memcpy(&numbers[i], bytes + offsets[i], sizeof(float));
  }
  return {{numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]}};
}

MeshColor colorFrom(const char* bytes, const std::array<int, 3>& offsets) {
  MeshColor color;
  for (int i = 0; i < 3; ++i) color[i] = static_cast<uint8_t>(bytes[offsets[i]]);
  return color;
}

void readVertices(PlyFile& file, const PlyHeader& header, TriangleMesh& mesh) {
  mesh.begin(header.size);
  std::vector<char> bytes;
  while (mesh.vertices.size() < header.size.vertices) {
    const size_t count = std::min<size_t>(kVerticesPerRead, header.size.vertices - mesh.vertices.size());
    bytes.resize(count * header.vertex_bytes);
    file.read(bytes.data(), bytes.size());
    for (size_t i = 0; i < count; ++i) {
      const char* vertex = &bytes[i * header.vertex_bytes];
      mesh.vertices.push_back(vertexFrom(vertex, header.offsets));
      if (header.size.colored) mesh.colors.push_back(colorFrom(vertex, header.color_offsets));
    }
  }
}

void readTriangles(PlyFile& file, const PlyHeader& header, std::vector<MeshTriangle>& triangles) {
  triangles.resize(header.size.triangles);
  for (MeshTriangle& triangle : triangles) {
    unsigned char corners = 0;
    file.read(&corners, 1);
    file.require(corners == 3,
                 "has a face of " + std::to_string(corners) + " corners; only triangles can be read");
    file.read(triangle.data(), sizeof(triangle));
    for (const uint32_t vertex : triangle) {
      file.require(vertex < header.size.vertices, "has a face with vertex " + std::to_string(vertex) +
                                                      " of " + std::to_string(header.size.vertices));
    }
  }
}

}  // namespace

TriangleMesh readPly(const std::string& path) {
  PlyFile file(path);
  const PlyHeader header = readHeader(file);
  file.requireBytesLeft(header.size.vertices * header.vertex_bytes +
                        header.size.triangles * (1 + sizeof(MeshTriangle)));
  TriangleMesh mesh;
  readVertices(file, header, mesh);
  readTriangles(file, header, mesh.triangles);
  return mesh;
}

}  // namespace depth_fusion
