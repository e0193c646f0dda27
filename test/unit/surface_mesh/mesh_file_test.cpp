#include "depth_fusion/surface_mesh/mesh_file.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "depth_fusion/surface_mesh/ply.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace depth_fusion {
namespace {

// An octahedron of odd numbers, tiny and huge ones among them.
TriangleMesh octahedron(bool colored) {
  TriangleMesh mesh;
  for (const float sign : {-1.0f, 1.0f}) {
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3f normal = sign * Eigen::Vector3f::Unit(axis);
      const Eigen::Vector3f centre(-1.0f / 3.0f, 1.23456e-7f, 12345.678f);
      mesh.vertices.push_back({centre + 0.7f * normal, normal});
      if (colored) mesh.colors.push_back({static_cast<uint8_t>(mesh.vertices.size()), 128, 255});
    }
  }
  mesh.triangles = {{3, 4, 5}, {4, 0, 5}, {0, 1, 5}, {1, 3, 5}, {4, 3, 2}, {0, 4, 2}, {1, 0, 2}, {3, 1, 2}};
  return mesh;
}

// Wide and flat, of more triangles than any writer gathers.
TriangleMesh grid() {
  constexpr uint32_t kSide = 200;
  TriangleMesh mesh;
  for (uint32_t i = 0; i < kSide * kSide; ++i) {
    mesh.vertices.push_back({{0.01f * (i % kSide), 0.01f * (i / kSide), 0.0f}, {0.0f, 0.0f, 1.0f}});
    if (i % kSide == 0 || i < kSide) continue;
    mesh.triangles.push_back({i - kSide - 1, i - kSide, i});
    mesh.triangles.push_back({i - kSide - 1, i, i - 1});
  }
  return mesh;
}

std::string readText(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// As a reader of one pass has it: a face may name only what stands before it.
TriangleMesh readObj(const std::string& path) {
  TriangleMesh mesh;
  std::vector<Eigen::Vector3f> normals;
  std::istringstream text(readText(path));
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    Eigen::Vector3f v;
    if (kind == "v") {
      words >> v.x() >> v.y() >> v.z();
      mesh.vertices.push_back({v, Eigen::Vector3f::Zero()});
      float red, green, blue;
      if (words >> red >> green >> blue) {
        mesh.colors.push_back({static_cast<uint8_t>(std::lround(255.0f * red)),
                               static_cast<uint8_t>(std::lround(255.0f * green)),
                               static_cast<uint8_t>(std::lround(255.0f * blue))});
      }
    } else if (kind == "vn") {
      words >> v.x() >> v.y() >> v.z();
      normals.push_back(v);
    } else if (kind == "f") {
      MeshTriangle triangle;
      for (uint32_t& vertex : triangle) {
        uint32_t normal;
        char slash, other_slash;
        words >> vertex >> slash >> other_slash >> normal;
        EXPECT_EQ(std::string({slash, other_slash}), "//");
        check(vertex >= 1 && vertex <= mesh.vertices.size() && normal == vertex, "bad face: " + line);
        mesh.vertices[--vertex].normal_W = normals.at(normal - 1);
      }
      mesh.triangles.push_back(triangle);
    } else {
      EXPECT_EQ(kind, "#") << line;
    }
    EXPECT_TRUE(words.eof() || !words.fail()) << line;
  }
  return mesh;
}

struct StlFacet {
  Eigen::Vector3f normal, corners[3];
};

std::vector<StlFacet> readStl(const std::string& path) {
  const std::string bytes = readText(path);
  uint32_t count = 0;
  std::memcpy(&count, &bytes.at(80), 4);
  check(bytes.size() == 84 + size_t{50} * count, path + " has a wrong size");
  check(bytes.compare(0, 5, "solid") != 0, path + " looks like a text file");
  std::vector<StlFacet> facets(count);
  for (uint32_t i = 0; i < count; ++i) std::memcpy(static_cast<void*>(&facets[i]), &bytes[84 + 50 * i], 48);
  return facets;
}

void expectSameMesh(const TriangleMesh& a, const TriangleMesh& b, float normal_tolerance) {
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.colors, b.colors);
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  for (size_t i = 0; i < a.vertices.size(); ++i) {
    EXPECT_EQ(a.vertices[i].position_W, b.vertices[i].position_W);
    EXPECT_LE((a.vertices[i].normal_W - b.vertices[i].normal_W).norm(), normal_tolerance);
  }
}

void expectFacets(const std::vector<StlFacet>& facets, const TriangleMesh& mesh) {
  ASSERT_EQ(facets.size(), mesh.triangles.size());
  for (size_t i = 0; i < facets.size(); ++i) {
    for (int corner = 0; corner < 3; ++corner)
      ASSERT_EQ(facets[i].corners[corner], mesh.vertices[mesh.triangles[i][corner]].position_W);
    const Eigen::Vector3f area_normal =
        (facets[i].corners[1] - facets[i].corners[0]).cross(facets[i].corners[2] - facets[i].corners[0]);
    ASSERT_LT((facets[i].normal - area_normal.normalized()).norm(), 1e-5f);
  }
}

class MeshFile : public testing::Test {
 protected:
  std::string pathOf(const std::string& name) const { return folder_.path() + "/" + name; }
  std::string write(const TriangleMesh& mesh, const std::string& name, const std::string& format = "") const {
    sendMesh(mesh, *createMeshFile(pathOf(name), format));
    return pathOf(name);
  }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
      names.push_back(entry.path().filename().string());
    return names;
  }

  TemporaryFolder folder_;
};

class MeshFileOfFormat : public MeshFile, public testing::WithParamInterface<const char*> {};

INSTANTIATE_TEST_SUITE_P(Formats, MeshFileOfFormat,
                         testing::Values("ply", "obj", "stl", "glb", "dae", "pcd"));

TEST_P(MeshFileOfFormat, piecesInAnyOrderGiveTheSameFile) {
  const TriangleMesh mesh = octahedron(true);
  const std::string whole = readText(write(mesh, "whole", GetParam()));
  {
    const auto file = createMeshFile(pathOf("pieces"), GetParam());
    file->begin({6, 8, true});
    file->addTriangles(mesh.triangles.data(), 5);
    for (int i = 0; i < 6; ++i) file->addVertices(&mesh.vertices[i], &mesh.colors[i], 1);
    file->addTriangles(mesh.triangles.data() + 5, 3);
    file->finish();
  }
  ASSERT_FALSE(whole.empty());
  EXPECT_EQ(readText(pathOf("pieces")), whole);
}

TEST_P(MeshFileOfFormat, appearsWhenItIsWhole) {
  const TriangleMesh mesh = octahedron(false);
  const auto file = createMeshFile(pathOf("mesh"), GetParam());
  file->begin({6, 8});
  file->addVertices(mesh.vertices.data(), nullptr, 6);
  file->addTriangles(mesh.triangles.data(), 8);
  EXPECT_FALSE(std::filesystem::exists(pathOf("mesh")));
  file->finish();
  EXPECT_EQ(files(), std::vector<std::string>{"mesh"});
}

TEST_P(MeshFileOfFormat, unfinishedLeavesNothingAndWhatWasThere) {
  std::ofstream(pathOf("mesh")) << "old";
  {
    const auto file = createMeshFile(pathOf("mesh"), GetParam());
    file->begin({6, 8});
    file->addVertices(octahedron(false).vertices.data(), nullptr, 6);
  }
  EXPECT_EQ(files(), std::vector<std::string>{"mesh"});
  EXPECT_EQ(readText(pathOf("mesh")), "old");
}

TEST_P(MeshFileOfFormat, replacesTheFileThatALinkNames) {
  std::ofstream(pathOf("target")) << "old";
  std::filesystem::create_symlink("target", pathOf("link"));
  const std::string written = readText(write(octahedron(false), "link", GetParam()));
  EXPECT_TRUE(std::filesystem::is_symlink(pathOf("link")));
  EXPECT_EQ(readText(pathOf("target")), written);
}

TEST_P(MeshFileOfFormat, fullDiskIsNamedAndTheDeviceStays) {
  expectError([] { sendMesh(octahedron(false), *createMeshFile("/dev/full", GetParam())); },
              {"/dev/full", "No space left on device"});
  EXPECT_TRUE(std::filesystem::exists("/dev/full"));
}

TEST_P(MeshFileOfFormat, missingFolderIsNamed) {
  expectError([&] { createMeshFile(pathOf("no/such/mesh"), GetParam()); },
              {pathOf("no/such/mesh"), "No such file or directory"});
}

TEST_P(MeshFileOfFormat, emptyMeshIsAFile) {
  write(TriangleMesh(), "mesh", GetParam());
  EXPECT_EQ(files(), std::vector<std::string>{"mesh"});
}

TEST_F(MeshFile, objHoldsTheMesh) {
  for (const bool colored : {false, true})
    expectSameMesh(readObj(write(octahedron(colored), "mesh.obj")), octahedron(colored), 1e-5f);
  expectSameMesh(readObj(write(grid(), "grid.obj")), grid(), 1e-5f);
  expectSameMesh(readObj(write(TriangleMesh(), "empty.obj")), TriangleMesh(), 0.0f);
}

TEST_F(MeshFile, stlHoldsTheTriangles) {
  expectFacets(readStl(write(octahedron(true), "mesh.stl")), octahedron(true));
  expectFacets(readStl(write(grid(), "grid.stl")), grid());
  expectFacets(readStl(write(TriangleMesh(), "empty.stl")), TriangleMesh());
}

TEST_F(MeshFile, formatIsThatOfTheEndingUnlessGiven) {
  const TriangleMesh mesh = octahedron(false);
  expectSameMesh(readPly(write(mesh, "mesh.PLY")), mesh, 0.0f);
  expectSameMesh(readPly(write(mesh, "mesh.obj", "ply")), mesh, 0.0f);
  EXPECT_EQ(readStl(write(mesh, "v1.2.Stl")).size(), mesh.triangles.size());
}

TEST_F(MeshFile, unknownFormatsAreNamedWithTheChoices) {
  const std::string choices = "ply, obj, stl, glb, dae, pcd";
  expectError([&] { createMeshFile(pathOf("mesh.fbx")); }, {pathOf("mesh.fbx"), "'fbx'", choices});
  expectError([&] { createMeshFile(pathOf("mesh.ply"), "PCD"); }, {"'PCD'", choices});
  expectError([&] { createMeshFile(pathOf("mesh")); }, {"no ending", choices});
  EXPECT_TRUE(files().empty());
}

TEST_F(MeshFile, glbThatIsTooLargeIsRefused) {
  const auto file = createMeshFile(pathOf("mesh.glb"));
  expectError([&] { file->begin({200000000, 400000000, true}); }, {pathOf("mesh.glb"), "4096", "ply"});
}

}  // namespace
}  // namespace depth_fusion
