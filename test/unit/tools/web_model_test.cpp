#include "tools/report/web_model.h"

#include <gtest/gtest.h>

#include <set>

#include "support/expect_error.h"
#include "tools/report/html.h"
#include "tools/report/level.h"

namespace depth_fusion {
namespace {

// A sphere of 1 m in rings of triangles; the upper half is red.
TriangleMesh sphereMesh(uint32_t rings) {
  TriangleMesh mesh;
  for (uint32_t i = 0; i <= rings; ++i) {
    for (uint32_t k = 0; k < 2 * rings; ++k) {
      const double rise = M_PI * (static_cast<double>(i) / rings - 0.5), turn = M_PI * k / rings;
      const Eigen::Vector3f p(static_cast<float>(std::cos(rise) * std::cos(turn)),
                              static_cast<float>(std::sin(rise)),
                              static_cast<float>(std::cos(rise) * std::sin(turn)));
      mesh.vertices.push_back({p, p});
      mesh.colors.push_back(p.y() < 0.0f ? MeshColor{200, 10, 10} : MeshColor{10, 10, 200});
    }
  }
  for (uint32_t i = 0; i < rings; ++i) {
    for (uint32_t k = 0; k < 2 * rings; ++k) {
      const uint32_t a = 2 * rings * i + k, b = 2 * rings * i + (k + 1) % (2 * rings);
      mesh.triangles.push_back({a, a + 2 * rings, b});
      mesh.triangles.push_back({b, a + 2 * rings, b + 2 * rings});
    }
  }
  return mesh;
}

TEST(WebModel, ThinnedMeshIsThereStill) {
  const TriangleMesh thin = thinned(sphereMesh(200), 5000);
  EXPECT_LE(thin.vertices.size(), 5000u);
  EXPECT_GT(thin.vertices.size(), 3500u);
  ASSERT_EQ(thin.colors.size(), thin.vertices.size());
  double area_m2 = 0.0;
  for (const MeshTriangle& t : thin.triangles) {
    ASSERT_EQ(std::set<uint32_t>(t.begin(), t.end()).size(), 3u);
    const Eigen::Vector3f a = thin.vertices[t[0]].position_W;
    area_m2 += (thin.vertices[t[1]].position_W - a).cross(thin.vertices[t[2]].position_W - a).norm() / 2.0;
  }
  EXPECT_NEAR(area_m2, 4.0 * M_PI, 0.1);
  for (size_t i = 0; i < thin.vertices.size(); ++i) {
    const Eigen::Vector3f& p = thin.vertices[i].position_W;
    EXPECT_NEAR(p.norm(), 1.0f, 0.01f);
    EXPECT_GT(p.normalized().dot(thin.vertices[i].normal_W), 0.98f);
    if (std::abs(p.y()) < 0.1f) continue;
    EXPECT_EQ(thin.colors[i][0], p.y() < 0.0f ? 200 : 10);
  }
}

TEST(WebModel, SmallMeshesStayAsTheyAre) {
  const TriangleMesh mesh = sphereMesh(10);
  const TriangleMesh same = thinned(mesh, 1000);
  EXPECT_EQ(same.vertices.size(), mesh.vertices.size());
  EXPECT_EQ(same.triangles, mesh.triangles);
}

std::vector<uint8_t> decoded(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<uint8_t> bytes;
  uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<uint32_t>(digits.find(c));
    count += 6;
    if (count >= 8) bytes.push_back(static_cast<uint8_t>(bits >> (count -= 8)));
  }
  return bytes;
}

TEST(WebModel, Base64IsThatOfTheStandard) {
  const auto of = [](const std::string& text) { return base64({text.begin(), text.end()}); };
  EXPECT_EQ(of(""), "");
  EXPECT_EQ(of("f"), "Zg==");
  EXPECT_EQ(of("fo"), "Zm8=");
  EXPECT_EQ(of("foo"), "Zm9v");
  EXPECT_EQ(of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(decoded(of("foobar")), (std::vector<uint8_t>{'f', 'o', 'o', 'b', 'a', 'r'}));
}

// As model_viewer.js reads it.
TEST(WebModel, BytesSayTheMesh) {
  const TriangleMesh mesh = sphereMesh(20);
  const std::string element = modelElement(mesh, {{0.0, Pose::Identity()}});
  const size_t begin = element.find("\">") + 2;
  const std::vector<uint8_t> bytes = decoded(element.substr(begin, element.find("</script>") - begin));
  const size_t n = mesh.vertices.size();
  for (size_t i = 0; i < n; ++i) {
    for (size_t axis = 0; axis < 3; ++axis) {
      const size_t at = 2 * (3 * i + axis);
      const double p = -1.0 + (bytes[at] | bytes[at + 1] << 8) * 2.0 / 65535.0;
      ASSERT_NEAR(p, mesh.vertices[i].position_W[static_cast<int>(axis)], 5e-5);
      ASSERT_NEAR(bytes[6 * n + 3 * i + axis] / 127.0 - 1.0,
                  mesh.vertices[i].normal_W[static_cast<int>(axis)], 0.005);
      ASSERT_EQ(bytes[9 * n + 3 * i + axis], mesh.colors[i][axis]);
    }
  }
  size_t at = 12 * n;
  int64_t last = 0;
  for (const MeshTriangle& triangle : mesh.triangles) {
    for (const uint32_t vertex : triangle) {
      uint32_t code = 0;
      for (int shift = 0;; shift += 7) {
        code |= (bytes[at] & 127u) << shift;
        if (bytes[at++] < 128) break;
      }
      last += (code & 1u) != 0 ? -static_cast<int64_t>((code + 1) / 2) : static_cast<int64_t>(code / 2);
      ASSERT_EQ(last, vertex);
    }
  }
  EXPECT_EQ(at, bytes.size());
  expectError([] { modelElement({}, {}); }, {"no surface"});
}

TEST(Level, FloorsAreLevelAfterwards) {
  TriangleMesh mesh;
  const Eigen::Matrix3f tilt =
      Eigen::AngleAxisf(0.5f, Eigen::Vector3f(1.0f, 0.0f, 0.3f).normalized()).matrix();
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3f normals[] = {{0.0f, -1.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f}};
    mesh.vertices.push_back({Eigen::Vector3f::Zero(), tilt * normals[i % 3]});
  }
  const Eigen::Vector3d up = levelFrom(mesh) * (tilt * Eigen::Vector3f(0.0f, -1.0f, 0.0f)).cast<double>();
  EXPECT_NEAR(up.y(), -1.0, 1e-4);
  TriangleMesh wall;
  wall.vertices.assign(100, {Eigen::Vector3f::Zero(), Eigen::Vector3f(0.0f, 0.1f, -1.0f).normalized()});
  EXPECT_TRUE(levelFrom(wall).isIdentity());
}

}  // namespace
}  // namespace depth_fusion
