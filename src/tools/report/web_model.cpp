#include "tools/report/web_model.h"

#include <algorithm>
#include <cmath>

#include "common/io/bytes.h"
#include "common/io/formatted_line.h"
#include "depth_fusion/common/error.h"
#include "tools/report/html.h"

namespace depth_fusion {
namespace {

constexpr float kMostSteps = 65535.0f;  // of a coordinate
constexpr size_t kMostPoses = 2000;

// Where the vertices are, and how far it is from one end to the other in the longest direction.
struct Extent {
  Eigen::Vector3f low;
  float length_m;
};

Extent extentOf(const TriangleMesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const MeshVertex& vertex : mesh.vertices) box.extend(vertex.position_W);
  return {box.min(), std::max(box.sizes().maxCoeff(), 1e-6f)};
}

class Encoder {
 public:
  void put(uint8_t byte) { bytes_.push_back(byte); }
  void putShort(float value) {
    const auto number = static_cast<uint32_t>(std::lround(std::clamp(value, 0.0f, kMostSteps)));
    put(static_cast<uint8_t>(number & 255u));
    put(static_cast<uint8_t>(number >> 8));
  }
  // The difference to the number before: its sign as the last bit, then seven bits a byte, the lowest first.
  void putDifference(uint32_t number) {
    const int64_t difference = static_cast<int64_t>(number) - last_;
    last_ = number;
    auto code = static_cast<uint64_t>(difference < 0 ? -2 * difference - 1 : 2 * difference);
    for (; code >= 128; code >>= 7) put(static_cast<uint8_t>((code & 127u) | 128u));
    put(static_cast<uint8_t>(code));
  }
  const std::vector<uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<uint8_t> bytes_;
  int64_t last_ = 0;
};

void putPoint(Encoder& encoder, const Eigen::Vector3f& p_W, const Extent& extent) {
  const Eigen::Vector3f steps = (p_W - extent.low) * (kMostSteps / extent.length_m);
  for (int axis = 0; axis < 3; ++axis) encoder.putShort(steps[axis]);
}

void putVertices(Encoder& encoder, const TriangleMesh& mesh, const Extent& extent) {
  for (const MeshVertex& vertex : mesh.vertices) putPoint(encoder, vertex.position_W, extent);
  for (const MeshVertex& vertex : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) {
      const float turned_up = 127.0f * (1.0f + std::clamp(vertex.normal_W[axis], -1.0f, 1.0f));
      encoder.put(static_cast<uint8_t>(std::lround(turned_up)));
    }
  }
  for (const MeshColor& color : mesh.colors) {
    for (const uint8_t channel : color) encoder.put(channel);
  }
}

// Position and direction of every so many poses, as 32-bit floats.
std::vector<uint8_t> wayOf(const Trajectory& trajectory, size_t stride) {
  ByteWriter writer;
  for (size_t i = 0; i < trajectory.size(); i += stride) {
    const Eigen::Vector3f p_W = trajectory[i].T_W_D.translation().cast<float>();
    const Eigen::Vector3f forward_W = trajectory[i].T_W_D.linear().col(2).cast<float>();
    for (int axis = 0; axis < 3; ++axis) writer.number(p_W[axis]);
    for (int axis = 0; axis < 3; ++axis) writer.number(forward_W[axis]);
  }
  const std::string bytes = writer.take();
  return {bytes.begin(), bytes.end()};
}

}  // namespace

std::string modelElement(const TriangleMesh& mesh, const Trajectory& trajectory) {
  check(!mesh.vertices.empty(), "there is no surface to be shown");
  const Extent extent = extentOf(mesh);
  Encoder encoder;
  putVertices(encoder, mesh, extent);
  for (const MeshTriangle& triangle : mesh.triangles) {
    for (const uint32_t vertex : triangle) encoder.putDifference(vertex);
  }
  const size_t stride = 1 + trajectory.size() / kMostPoses;
  return line(
             "<script type=\"application/octet-stream\" id=\"model\" data-vertices=\"%zu\" "
             "data-triangles=\"%zu\" data-colored=\"%d\" data-low=\"%.9g %.9g %.9g\" "
             "data-step=\"%.9g\"",
             mesh.vertices.size(), mesh.triangles.size(), mesh.colors.empty() ? 0 : 1,
             static_cast<double>(extent.low.x()), static_cast<double>(extent.low.y()),
             static_cast<double>(extent.low.z()), static_cast<double>(extent.length_m / kMostSteps)) +
         "data-way=\"" + base64(wayOf(trajectory, stride)) + "\">" + base64(encoder.bytes()) + "</script>\n";
}

}  // namespace depth_fusion
