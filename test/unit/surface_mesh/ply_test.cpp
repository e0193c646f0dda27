#include "depth_fusion/surface_mesh/ply.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <iterator>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  for (const Eigen::Vector3f& corner :
       {Eigen::Vector3f(0.0f, 0.0f, 0.0f), Eigen::Vector3f(0.25f, 0.0f, 0.0f),
        Eigen::Vector3f(0.0f, -1e-3f, 0.0f), Eigen::Vector3f(0.0f, 0.0f, 3e4f)}) {
    mesh.vertices.push_back({corner, (corner + Eigen::Vector3f(0.5f, 0.25f, -0.125f)).normalized()});
  }
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return mesh;
}

bool exists(const std::string& path) {
  struct stat status {};
  return lstat(path.c_str(), &status) == 0;
}

template <class Action>
std::string errorOf(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

class Ply : public testing::Test {
 protected:
  ~Ply() override { std::remove(path_.c_str()); }

  void writeText(const std::string& text) const { std::ofstream(path_, std::ios::binary) << text; }
  std::string readText() const {
    std::ifstream stream(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  const std::string path_ = testing::TempDir() + "depth_fusion_ply_test_" + std::to_string(getpid()) + ".ply";
};

TEST_F(Ply, readsTheColorsItWrote) {
  TriangleMesh mesh = tetrahedron();
  mesh.colors = {{0, 1, 2}, {255, 128, 7}, {13, 10, 0}, {200, 201, 202}};
  writePly(path_, mesh);
  EXPECT_NE(readText().find("property uchar red\nproperty uchar green\nproperty uchar blue\n"),
            std::string::npos);
  const TriangleMesh read = readPly(path_);
  EXPECT_EQ(read.colors, mesh.colors);
  EXPECT_EQ(read.triangles, mesh.triangles);
  ASSERT_EQ(read.vertices.size(), mesh.vertices.size());
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    EXPECT_EQ(read.vertices[i].position_W, mesh.vertices[i].position_W);
    EXPECT_EQ(read.vertices[i].normal_W, mesh.vertices[i].normal_W);
  }
}

// Other tools write colours of other types, or a part of them; neither is one that can be drawn.
TEST_F(Ply, colorsOfOtherTypesAreLeftOut) {
  writeText(
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty "
      "float z\n"
      "property float red\nproperty uchar green\nproperty uchar blue\nelement face 0\n"
      "property list uchar int vertex_indices\nend_header\n" +
      std::string(18, '\0'));
  const TriangleMesh read = readPly(path_);
  EXPECT_EQ(read.vertices.size(), 1u);
  EXPECT_TRUE(read.colors.empty());
}

TEST_F(Ply, readsWhatItWrote) {
  const TriangleMesh mesh = tetrahedron();
  writePly(path_, mesh);
  const TriangleMesh read = readPly(path_);
  EXPECT_EQ(read.triangles, mesh.triangles);
  ASSERT_EQ(read.vertices.size(), mesh.vertices.size());
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    EXPECT_EQ(read.vertices[i].position_W, mesh.vertices[i].position_W);
    EXPECT_EQ(read.vertices[i].normal_W, mesh.vertices[i].normal_W);
  }
}

TEST_F(Ply, piecesGiveTheSameFile) {
  const TriangleMesh mesh = tetrahedron();
  writePly(path_, mesh);
  const std::string whole = readText();
  PlyWriter writer(path_);
  writer.begin({4, 4});
  for (int i = 0; i < 4; ++i) {
    writer.addTriangles(&mesh.triangles[i], 1);
    writer.addVertices(&mesh.vertices[i], nullptr, 1);
  }
  writer.finish();
  EXPECT_EQ(readText(), whole);
}

TEST_F(Ply, manyTrianglesKeepTheirOrder) {
  TriangleMesh mesh = tetrahedron();
  for (uint32_t i = 0; i < 100000; ++i) mesh.triangles.push_back({i % 4, i / 4 % 4, i / 16 % 4});
  writePly(path_, mesh);
  EXPECT_EQ(readPly(path_).triangles, mesh.triangles);
}

TEST_F(Ply, emptyMeshIsAFile) {
  writePly(path_, TriangleMesh());
  EXPECT_TRUE(readPly(path_).vertices.empty());
}

TEST_F(Ply, unwritablePathIsNamed) {
  const std::string path = testing::TempDir() + "no/such/folder/mesh.ply";
  const std::string error = errorOf([&] { PlyWriter writer(path); });
  EXPECT_NE(error.find(path), std::string::npos) << error;
  EXPECT_NE(error.find("No such file or directory"), std::string::npos) << error;
}

TEST_F(Ply, fullDiskIsNamedAndTheDeviceStays) {
  const std::string error = errorOf([] { writePly("/dev/full", tetrahedron()); });
  EXPECT_NE(error.find("/dev/full"), std::string::npos) << error;
  EXPECT_NE(error.find("No space left on device"), std::string::npos) << error;
  EXPECT_TRUE(exists("/dev/full"));
}

TEST_F(Ply, skipsOtherNumbersAndMissingNormals) {
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar red\nproperty float x\n"
      "property float y\nproperty float z\nelement face 1\nproperty list uchar int "
      "vertex_indices\nend_header\n";
  for (int i = 0; i < 3; ++i) {
    const float position[3] = {static_cast<float>(i), 2.0f, 3.0f};
    text += '\7';
    text.append(reinterpret_cast<const char*>(position), sizeof(position));
  }
  const int indices[3] = {2, 0, 1};
  text += '\3';
  text.append(reinterpret_cast<const char*>(indices), sizeof(indices));
  writeText(text);
  const TriangleMesh mesh = readPly(path_);
  EXPECT_EQ(mesh.vertices[2].position_W, Eigen::Vector3f(2.0f, 2.0f, 3.0f));
  EXPECT_EQ(mesh.vertices[2].normal_W, Eigen::Vector3f::Zero());
  EXPECT_EQ(mesh.triangles[0], (MeshTriangle{2, 0, 1}));
}

TEST_F(Ply, badFilesAreNamedWithTheirProblem) {
  writePly(path_, tetrahedron());
  const std::string good = readText();
  const auto errorOfText = [&](const std::string& text) {
    writeText(text);
    return errorOf([&] { readPly(path_); });
  };
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return text.replace(text.find(from), from.size(), to);
  };
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "ends within its header"},
      {"solid\n", "is no PLY file"},
      {good.substr(0, good.size() - 1), "ends before"},
      {replaced("vertex 4", "vertex 99999999999"), "ends before"},
      {replaced("binary_little_endian", "ascii"), "only binary_little_endian"},
      {replaced("float x", "double x"), "only float"},
      {replaced("float z", "float q"), "without x, y, z"},
      {replaced("uchar int", "uchar short"), "list uchar int"},
  };
  for (const auto& c : cases) {
    const std::string error = errorOfText(c.first);
    EXPECT_NE(error.find(path_), std::string::npos) << error;
    EXPECT_NE(error.find(c.second), std::string::npos) << error;
  }
  std::string far_vertex = good;
  far_vertex[far_vertex.size() - 4] = 4;
  EXPECT_NE(errorOfText(far_vertex).find("vertex 4 of 4"), std::string::npos);
  EXPECT_NE(errorOf([&] { readPly(path_ + "x"); }).find("No such file"), std::string::npos);
}

}  // namespace
}  // namespace depth_fusion
