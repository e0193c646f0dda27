// Files that assimp reads.
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "apps/view/model.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

constexpr unsigned int kSteps = aiProcess_Triangulate | aiProcess_GenSmoothNormals |
                                aiProcess_PreTransformVertices | aiProcess_SortByPType;

// glTF's colours are linear in the light.
uint8_t byteOf(float value, bool is_linear) {
  const float v = std::clamp(value, 0.0f, 1.0f);
  const float shown = !is_linear        ? v
                      : v <= 0.0031308f ? 12.92f * v
                                        : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f;
  return static_cast<uint8_t>(std::lround(255.0f * shown));
}

// The picture that a material has, inside the file or beside it; empty if it has none.
cv::Mat pageOf(const aiScene& scene, const aiMesh& part, const std::string& path) {
  aiString name;
  if (!part.HasTextureCoords(0) ||
      scene.mMaterials[part.mMaterialIndex]->GetTexture(aiTextureType_DIFFUSE, 0, &name) != aiReturn_SUCCESS)
    return {};
  const aiTexture* inside = scene.GetEmbeddedTexture(name.C_Str());
  const std::string beside = (std::filesystem::path(path).parent_path() / name.C_Str()).string();
  const cv::Mat page = inside == nullptr ? cv::imread(beside, cv::IMREAD_COLOR)
                                         : cv::imdecode(cv::Mat(1, static_cast<int>(inside->mWidth), CV_8U,
                                                                static_cast<void*>(inside->pcData)),
                                                        cv::IMREAD_COLOR);
  check(!page.empty(), path + ": its texture " + (inside == nullptr ? beside : "") + " cannot be read");
  return page;
}

// The frame of the format, in which y is up and z points to the viewer, or that of a camera that is held
// level.
Eigen::Vector3f turned(const aiVector3D& v, bool y_is_up) {
  return y_is_up ? Eigen::Vector3f(v.x, -v.y, -v.z) : Eigen::Vector3f(v.x, v.y, v.z);
}

void add(const aiMesh& part, bool is_gltf, bool y_is_up, ViewedModel& model) {
  TriangleMesh& mesh = model.mesh;
  const auto first = static_cast<uint32_t>(mesh.vertices.size());
  for (unsigned int i = 0; i < part.mNumVertices; ++i) {
    mesh.vertices.push_back({turned(part.mVertices[i], y_is_up), turned(part.mNormals[i], y_is_up)});
    if (part.HasVertexColors(0)) {
      const aiColor4D& c = part.mColors[0][i];
      mesh.colors.push_back({byteOf(c.r, is_gltf), byteOf(c.g, is_gltf), byteOf(c.b, is_gltf)});
    }
    if (part.HasTextureCoords(0))
      model.shares.emplace_back(part.mTextureCoords[0][i].x, part.mTextureCoords[0][i].y);
  }
  for (unsigned int i = 0; i < part.mNumFaces; ++i) {
    const unsigned int* corners = part.mFaces[i].mIndices;
    mesh.triangles.push_back({first + corners[0], first + corners[1], first + corners[2]});
  }
}

}  // namespace

ViewedModel readByAssimp(const std::string& path) {
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFile(path, kSteps);
  check(scene != nullptr, path + " cannot be read: " + importer.GetErrorString());
  const std::string ending = endingOf(path);
  const bool is_gltf = ending == "glb" || ending == "gltf";
  ViewedModel model;
  for (unsigned int i = 0; i < scene->mNumMeshes; ++i) {
    const aiMesh& part = *scene->mMeshes[i];
    add(part, is_gltf, is_gltf || ending == "dae", model);
    const cv::Mat page = pageOf(*scene, part, path);
    if (page.empty()) continue;
    model.pages.push_back(page);
    model.page_ends.push_back(model.mesh.triangles.size());
  }
  if (model.mesh.colors.size() != model.mesh.vertices.size()) model.mesh.colors.clear();
  if (model.pages.size() != scene->mNumMeshes) model.pages.clear();  // only a part has one
  return model;
}

}  // namespace depth_fusion
