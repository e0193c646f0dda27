// Mesh files as other libraries read them.
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "depth_fusion/surface_mesh/mesh_file.h"
#include "depth_fusion/texturing/textured_mesh.h"
#include "support/expect_error.h"
#include "support/file_bytes.h"
#include "support/temporary_folder.h"

#ifdef DEPTH_FUSION_TESTS_HAVE_PCL
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>
#endif
#ifdef DEPTH_FUSION_TESTS_HAVE_TINYGLTF
#include <tiny_gltf.h>
#endif

namespace depth_fusion {
namespace {

// A square pyramid with sides of its own colours: corners of the base, then the tip, which points to z.
TriangleMesh pyramid(bool colored) {
  TriangleMesh mesh;
  for (const Eigen::Vector3f& p :
       {Eigen::Vector3f(-1, -1, 0), Eigen::Vector3f(1, -1, 0), Eigen::Vector3f(1, 1, 0),
        Eigen::Vector3f(-1, 1, 0), Eigen::Vector3f(0, 0, 2)}) {
    mesh.vertices.push_back(
        {p + Eigen::Vector3f(0.125f, -3.5f, 10.0f), (p + Eigen::Vector3f(0, 0, -0.5f)).normalized()});
    if (colored) mesh.colors.push_back({static_cast<uint8_t>(50 * mesh.vertices.size()), 0, 255});
  }
  mesh.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {0, 2, 1}, {0, 3, 2}};
  return mesh;
}

float linear(uint8_t value) {
  const double v = value / 255.0;
  return static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
}

struct Opening {
  const char* format;
  bool has_colors, has_shared_vertices, turns;
};

class OtherReaders : public testing::TestWithParam<Opening> {
 protected:
  // Where the reader has a point of the map, with z up.
  Eigen::Vector3f placed(const Eigen::Vector3f& p) const {
    return GetParam().turns ? Eigen::Vector3f(p.x(), p.z(), -p.y()) : p;
  }
};

INSTANTIATE_TEST_SUITE_P(Formats, OtherReaders,
                         testing::Values(Opening{"ply", true, true, false}, Opening{"obj", true, true, false},
                                         Opening{"stl", false, false, false},
                                         Opening{"glb", true, true, true}, Opening{"dae", true, true, true}),
                         [](const auto& opening) { return opening.param.format; });

TEST_P(OtherReaders, assimpFindsTheMesh) {
  const TemporaryFolder folder;
  const std::string path = folder / ("pyramid." + std::string(GetParam().format));
  const TriangleMesh mesh = pyramid(true);
  sendMesh(mesh, *createMeshFile(path, "", UpAxis::kZ));
  Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFile(path, aiProcess_JoinIdenticalVertices | aiProcess_PreTransformVertices);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  ASSERT_EQ(scene->mNumMeshes, 1u);
  const aiMesh& read = *scene->mMeshes[0];
  ASSERT_EQ(read.mNumFaces, mesh.triangles.size());
  ASSERT_TRUE(read.HasNormals());
  EXPECT_EQ(read.HasVertexColors(0), GetParam().has_colors);
  const bool is_linear = std::string(GetParam().format) == "glb";
  for (unsigned int face = 0; face < read.mNumFaces; ++face) {
    ASSERT_EQ(read.mFaces[face].mNumIndices, 3u);
    for (int i = 0; i < 3; ++i) {
      const unsigned int index = read.mFaces[face].mIndices[i];
      const uint32_t vertex = mesh.triangles[face][i];
      const aiVector3D& p = read.mVertices[index];
      const aiVector3D& n = read.mNormals[index];
      EXPECT_LT((Eigen::Vector3f(p.x, p.y, p.z) - placed(mesh.vertices[vertex].position_W)).norm(), 1e-5f);
      if (GetParam().has_shared_vertices) {
        EXPECT_LT((Eigen::Vector3f(n.x, n.y, n.z) - placed(mesh.vertices[vertex].normal_W)).norm(), 1e-4f);
      }
      if (!GetParam().has_colors) continue;
      const uint8_t red = mesh.colors[vertex][0];
      EXPECT_NEAR(read.mColors[0][index].r, is_linear ? linear(red) : static_cast<float>(red) / 255.0f,
                  1e-4f);
      EXPECT_NEAR(read.mColors[0][index].b, 1.0f, 1e-4f);
    }
  }
}

TEST_P(OtherReaders, assimpFindsNoColorsWhereThereAreNone) {
  const TemporaryFolder folder;
  const std::string path = folder / ("pyramid." + std::string(GetParam().format));
  sendMesh(pyramid(false), *createMeshFile(path));
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, 0);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  EXPECT_FALSE(scene->mMeshes[0]->HasVertexColors(0));
}

TEST(GltfAxis, aLevelCamerasUpIsUp) {
  const TemporaryFolder folder;
  for (const std::string format : {"glb", "dae"}) {
    const std::string path = folder / ("pyramid." + format);
    sendMesh(pyramid(false), *createMeshFile(path, "", UpAxis::kMinusY));
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path, aiProcess_PreTransformVertices);
    ASSERT_NE(scene, nullptr) << importer.GetErrorString();
    const aiVector3D& p = scene->mMeshes[0]->mVertices[scene->mMeshes[0]->mFaces[0].mIndices[0]];
    const Eigen::Vector3f p_W = pyramid(false).vertices[0].position_W;
    EXPECT_LT((Eigen::Vector3f(p.x, p.y, p.z) - Eigen::Vector3f(p_W.x(), -p_W.y(), -p_W.z())).norm(), 1e-4f)
        << format;
  }
}

// The pyramid's sides on two pages, a colour each.
TexturedMesh texturedPyramid() {
  TexturedMesh textured;
  const TriangleMesh mesh = pyramid(false);
  for (size_t face = 0; face < 4; ++face) {
    const auto first = static_cast<uint32_t>(textured.mesh.vertices.size());
    for (const uint32_t vertex : mesh.triangles[face])
      textured.mesh.vertices.push_back(mesh.vertices[vertex]);
    textured.mesh.triangles.push_back({first, first + 1, first + 2});
    const float x = face % 2 == 0 ? 0.0f : 8.0f;
    textured.places.insert(textured.places.end(), {{x, 0.0f}, {x + 7.0f, 0.0f}, {x, 3.0f}});
  }
  textured.page_ends = {2, 4};
  for (const int red : {100, 200}) {
    textured.pages.emplace_back(4, 16, CV_8UC3, cv::Scalar(0, 0, red));
    textured.pages.back().colRange(8, 16).setTo(cv::Scalar(0, 255, red));
  }
  return textured;
}

// The pixel of a page that a vertex has.
cv::Vec3b colorAt(const aiMesh& mesh, unsigned int vertex, const cv::Mat& page) {
  const aiVector3D& share = mesh.mTextureCoords[0][vertex];  // assimp's v goes up
  return page.at<cv::Vec3b>(cvRound((1.0f - share.y) * static_cast<float>(page.rows) - 0.5f),
                            cvRound(share.x * static_cast<float>(page.cols) - 0.5f));
}

TEST(TexturedMeshFile, assimpFindsEachFacesPicture) {
  const TemporaryFolder folder;
  const TexturedMesh textured = texturedPyramid();
  for (const std::string format : {"obj", "glb"}) {
    const std::string path = folder / ("pyramid." + format);
    writeTexturedMesh(path, textured, UpAxis::kMinusY);
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path, 0);
    ASSERT_NE(scene, nullptr) << importer.GetErrorString();
    ASSERT_EQ(scene->mNumMeshes, 2u) << format;
    for (unsigned int page = 0; page < 2; ++page) {
      const aiMesh& mesh = *scene->mMeshes[page];
      ASSERT_EQ(mesh.mNumFaces, 2u);
      ASSERT_TRUE(mesh.HasTextureCoords(0));
      aiString name;
      ASSERT_EQ(scene->mMaterials[mesh.mMaterialIndex]->GetTexture(aiTextureType_DIFFUSE, 0, &name),
                aiReturn_SUCCESS);
      const aiTexture* embedded = scene->GetEmbeddedTexture(name.C_Str());
      const cv::Mat picture =
          embedded != nullptr
              ? cv::imdecode(cv::Mat(1, static_cast<int>(embedded->mWidth), CV_8U, embedded->pcData),
                             cv::IMREAD_COLOR)
              : cv::imread(folder / name.C_Str());
      ASSERT_EQ(picture.size(), textured.pages[page].size()) << format;
      for (unsigned int face = 0; face < 2; ++face) {
        for (unsigned int i = 0; i < 3; ++i) {
          const cv::Vec3b color = colorAt(mesh, mesh.mFaces[face].mIndices[i], picture);
          EXPECT_EQ(color, cv::Vec3b(0, face == 0 ? 0 : 255, static_cast<uchar>(100 + 100 * page))) << format;
        }
      }
    }
  }
}

// Where a PLY file's faces have their places in pictures.
struct PlyFace {
  uint8_t corners;
  std::array<int32_t, 3> vertices;
  uint8_t numbers;
  std::array<float, 6> shares;
  int32_t page;
} __attribute__((packed));

TEST(TexturedMeshFile, plyNamesEachFacesPicture) {
  const TemporaryFolder folder;
  const TexturedMesh textured = texturedPyramid();
  writeTexturedMesh(folder / "pyramid.ply", textured);
  const std::string bytes = fileBytes(folder / "pyramid.ply");
  const size_t begin = bytes.find("end_header\n") + 11;
  const std::string header = bytes.substr(0, begin);
  for (const char* line : {"comment TextureFile pyramid_0.png\n", "comment TextureFile pyramid_1.png\n",
                           "property list uchar float texcoord\nproperty int texnumber\n"})
    EXPECT_NE(header.find(line), std::string::npos) << line << header;
  ASSERT_EQ(bytes.size(), begin + 12 * sizeof(MeshVertex) + 4 * sizeof(PlyFace));
  for (size_t i = 0; i < 4; ++i) {
    PlyFace face{};
    std::memcpy(&face, &bytes[begin + 12 * sizeof(MeshVertex) + i * sizeof(PlyFace)], sizeof(face));
    EXPECT_EQ(face.corners, 3);
    EXPECT_EQ(face.numbers, 6);
    const int32_t page = face.page;
    EXPECT_EQ(page, static_cast<int32_t>(i / 2));
    const cv::Mat picture = cv::imread(folder / ("pyramid_" + std::to_string(page) + ".png"));
    ASSERT_EQ(picture.size(), textured.pages[i / 2].size());
    for (size_t k = 0; k < 3; ++k) {
      const float u = face.shares[2 * k], v = face.shares[2 * k + 1];
      const Eigen::Vector2f place(u * 16.0f - 0.5f, (1.0f - v) * 4.0f - 0.5f);
      EXPECT_LT((place - textured.places[textured.mesh.triangles[i][k]]).norm(), 1e-4f);
    }
  }
}

TEST(TexturedMeshFile, assimpFindsTheTextureOfAPly) {
  const TemporaryFolder folder;
  TexturedMesh textured = texturedPyramid();
  textured.mesh.triangles.resize(2);
  textured.page_ends.resize(1);
  textured.pages.resize(1);
  writeTexturedMesh(folder / "pyramid.ply", textured);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(folder / "pyramid.ply", 0);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  const aiMesh& mesh = *scene->mMeshes[0];
  ASSERT_TRUE(mesh.HasTextureCoords(0));
  aiString name;
  ASSERT_EQ(scene->mMaterials[mesh.mMaterialIndex]->GetTexture(aiTextureType_DIFFUSE, 0, &name),
            aiReturn_SUCCESS);
  EXPECT_EQ(std::string(name.C_Str()), "pyramid_0.png");
  for (unsigned int face = 0; face < 2; ++face) {
    for (unsigned int i = 0; i < 3; ++i)
      EXPECT_EQ(colorAt(mesh, mesh.mFaces[face].mIndices[i], textured.pages[0]),
                cv::Vec3b(0, face == 0 ? 0 : 255, 100));
  }
}

TEST(TexturedMeshFile, badPathsAreNamed) {
  const TemporaryFolder folder;
  expectError([&] { writeTexturedMesh(folder / "mesh.stl", texturedPyramid()); },
              {"mesh.stl", ".obj, .glb or .ply"});
  expectError([&] { writeTexturedMesh(folder / "no/such/mesh.glb", texturedPyramid()); },
              {"no/such", "does not exist"});
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(TexturedMeshFile, whatCannotBeWrittenLeavesNothing) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "mesh_1.png");  // a page cannot be written there
  std::ofstream(folder / "mesh.obj") << "old";
  expectError([&] { writeTexturedMesh(folder / "mesh.obj", texturedPyramid()); }, {"mesh_1.png"});
  EXPECT_EQ(std::filesystem::file_size(folder / "mesh.obj"), 3u);
  EXPECT_FALSE(std::filesystem::exists(folder / "mesh_0.png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "mesh.mtl"));
}

#ifdef DEPTH_FUSION_TESTS_HAVE_TINYGLTF
TEST(Gltf, tinygltfTakesItAsItIs) {
  const TemporaryFolder folder;
  const std::string path = folder / "pyramid.glb";
  sendMesh(pyramid(true), *createMeshFile(path));
  tinygltf::TinyGLTF loader;
  tinygltf::Model model;
  std::string error, warning;
  ASSERT_TRUE(loader.LoadBinaryFromFile(&model, &error, &warning, path)) << error;
  EXPECT_EQ(error + warning, "");
  const tinygltf::Primitive& primitive = model.meshes.at(0).primitives.at(0);
  EXPECT_EQ(primitive.attributes.size(), 3u);
  const tinygltf::Accessor& positions = model.accessors.at(primitive.attributes.at("POSITION"));
  EXPECT_EQ(positions.count, 5u);
  EXPECT_EQ(positions.minValues, (std::vector<double>{-0.875, -4.5, 10.0}));
  EXPECT_EQ(positions.maxValues, (std::vector<double>{1.125, -2.5, 12.0}));
  EXPECT_EQ(model.accessors.at(primitive.indices).count, 18u);
  EXPECT_EQ(model.materials.at(0).extensions.count("KHR_materials_unlit"), 1u);
}
#endif

#ifdef DEPTH_FUSION_TESTS_HAVE_PCL
TEST(Pcd, pclReadsThePoints) {
  const TemporaryFolder folder;
  for (const bool colored : {false, true}) {
    const TriangleMesh mesh = pyramid(colored);
    sendMesh(mesh, *createMeshFile(folder / "points.pcd"));
    pcl::PointCloud<pcl::PointNormal> points;
    ASSERT_EQ(pcl::io::loadPCDFile(folder / "points.pcd", points), 0);
    ASSERT_EQ(points.size(), mesh.vertices.size());
    for (size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(points[i].getVector3fMap(), mesh.vertices[i].position_W);
      EXPECT_EQ(points[i].getNormalVector3fMap(), mesh.vertices[i].normal_W);
    }
    if (!colored) continue;
    pcl::PointCloud<pcl::PointXYZRGB> colors;
    ASSERT_EQ(pcl::io::loadPCDFile(folder / "points.pcd", colors), 0);
    for (size_t i = 0; i < colors.size(); ++i)
      EXPECT_EQ((MeshColor{colors[i].r, colors[i].g, colors[i].b}), mesh.colors[i]);
  }
}
#endif

}  // namespace
}  // namespace depth_fusion
