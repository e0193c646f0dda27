#include "surface_mesh/glb_file.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

constexpr uint32_t kMagic = 0x46546C67, kVersion = 2, kTextChunk = 0x4E4F534A, kDataChunk = 0x004E4942;
constexpr uint64_t kHeadBytes = 12, kChunkHeadBytes = 8;

constexpr uint64_t padded(uint64_t bytes) { return (bytes + 3) / 4 * 4; }

std::string numberText(float number) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.9g", static_cast<double>(number));
  return text;
}

std::array<uint16_t, 256> linearTable() {
  std::array<uint16_t, 256> table{};
  for (size_t i = 0; i < table.size(); ++i) {
    const double value = static_cast<double>(i) / 255.0;
    const double linear = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
    table[i] = static_cast<uint16_t>(std::lround(65535.0 * linear));
  }
  return table;
}

}  // namespace

void GlbFile::begin(uint64_t text_bytes, uint64_t data_bytes) {
  text_bytes_ = padded(text_bytes);
  data_bytes_ = padded(data_bytes);
  const uint64_t all = kHeadBytes + 2 * kChunkHeadBytes + text_bytes_ + data_bytes_;
  check(all <= std::numeric_limits<uint32_t>::max(),
        "mesh file " + path_ + " would take " + std::to_string(all >> 20) +
            " MiB; a .glb file holds 4096; use ply or fewer triangles");
}

void GlbFile::write(uint64_t offset, const void* data, size_t bytes) {
  file_.writeAt(kHeadBytes + 2 * kChunkHeadBytes + text_bytes_ + offset, data, bytes);
}

void GlbFile::finish(std::string text) {
  check(text.size() <= text_bytes_, "the description of a .glb file is longer than was thought");
  text.resize(text_bytes_, ' ');
  const uint64_t data_chunk_bytes = data_bytes_ == 0 ? 0 : kChunkHeadBytes + data_bytes_;
  const uint64_t data_chunk = kHeadBytes + kChunkHeadBytes + text_bytes_;
  const uint32_t head[5] = {kMagic, kVersion, static_cast<uint32_t>(data_chunk + data_chunk_bytes),
                            static_cast<uint32_t>(text_bytes_), kTextChunk};
  file_.writeAt(0, head, sizeof(head));
  file_.writeAt(sizeof(head), text.data(), text.size());
  if (data_chunk_bytes > 0) {
    const uint32_t data_head[2] = {static_cast<uint32_t>(data_bytes_), kDataChunk};
    file_.writeAt(data_chunk, data_head, sizeof(data_head));
    file_.cutTo(data_chunk + data_chunk_bytes);
  }
  file_.commit();
}

std::string glbHead(UpAxis up) {
  const char* rotation = up == UpAxis::kZ ? "[-0.70710678,0,0,0.70710678]" : "[1,0,0,0]";
  return std::string(R"("asset":{"version":"2.0","generator":"depth_fusion"},"scene":0,)") +
         R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"rotation":)" + rotation + "}]";
}

std::string glbBuffer(uint64_t bytes) {
  return R"("buffers":[{"byteLength":)" + std::to_string(padded(bytes)) + "}]";
}

std::string glbView(const GlbPart& part, int target) {
  return R"({"buffer":0,"byteOffset":)" + std::to_string(part.offset) + R"(,"byteLength":)" +
         std::to_string(part.bytes) + (target == 0 ? "" : R"(,"target":)" + std::to_string(target)) + "}";
}

std::string glbAccessor(int view, uint64_t count, int component, const char* type, const std::string& more) {
  return R"({"bufferView":)" + std::to_string(view) + R"(,"count":)" + std::to_string(count) +
         R"(,"componentType":)" + std::to_string(component) + R"(,"type":")" + type + "\"" + more + "}";
}

std::string glbBounds(const Eigen::AlignedBox3f& box) {
  const auto corner = [](const Eigen::Vector3f& p) {
    return "[" + numberText(p.x()) + "," + numberText(p.y()) + "," + numberText(p.z()) + "]";
  };
  return R"(,"min":)" + corner(box.min()) + R"(,"max":)" + corner(box.max());
}

std::array<uint16_t, 4> linearColor(const MeshColor& color) {
  static const std::array<uint16_t, 256> table = linearTable();
  return {table[color[0]], table[color[1]], table[color[2]], 65535};
}

}  // namespace depth_fusion
