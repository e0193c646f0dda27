#include "ros/input/robot_model.h"

#include <ros/package.h>
#include <urdf/model.h>

#include <memory>

#include "depth_fusion/common/error.h"

#ifdef DEPTH_FUSION_HAS_ASSIMP
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#endif

namespace depth_fusion {
namespace {

// package://PACKAGE/FILE and file://FILE as paths.
std::string pathOf(const std::string& uri) {
  const std::string package = "package://", file = "file://";
  if (uri.compare(0, file.size(), file) == 0) return uri.substr(file.size());
  if (uri.compare(0, package.size(), package) != 0) return uri;
  const size_t end = uri.find('/', package.size());
  check(end != std::string::npos, "the mesh " + uri + " of the URDF names no file");
  const std::string name = uri.substr(package.size(), end - package.size());
  const std::string folder = ros::package::getPath(name);
  check(!folder.empty(),
        "the mesh " + uri + " of the URDF is in the package " + name + ", which is not there");
  return folder + uri.substr(end);
}

#ifdef DEPTH_FUSION_HAS_ASSIMP
Eigen::AlignedBox3d boundsOf(const std::string& uri) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);  // as rviz has it
  const aiScene* scene = importer.ReadFile(pathOf(uri), aiProcess_PreTransformVertices);
  check(scene != nullptr, "the mesh " + uri + " of the URDF cannot be read: " + importer.GetErrorString());
  Eigen::AlignedBox3d bounds;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    const aiMesh& mesh = *scene->mMeshes[i];
    for (unsigned v = 0; v < mesh.mNumVertices; ++v)
      bounds.extend(Eigen::Vector3d(mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z));
  }
  check(!bounds.isEmpty(), "the mesh " + uri + " of the URDF has no vertices");
  return bounds;
}
#else
Eigen::AlignedBox3d boundsOf(const std::string& uri) {
  throw Error("the mesh " + uri +
              " of the URDF cannot be read, for this was built without assimp; install "
              "libassimp-dev and build again, or give solids by masking/body");
}
#endif

Pose poseOf(const urdf::Pose& pose) {
  Pose T_F_S = Pose::Identity();
  Eigen::Quaterniond rotation;
  pose.rotation.getQuaternion(rotation.x(), rotation.y(), rotation.z(), rotation.w());
  T_F_S.linear() = rotation.normalized().toRotationMatrix();
  T_F_S.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  return T_F_S;
}

BodyPart partOfMesh(const std::string& frame, const Pose& T_F_M, const urdf::Mesh& mesh) {
  const Eigen::Vector3d scale(mesh.scale.x, mesh.scale.y, mesh.scale.z);
  const Eigen::AlignedBox3d bounds = boundsOf(mesh.filename);
  Pose T_F_S = T_F_M;
  T_F_S.translation() = T_F_M * bounds.center().cwiseProduct(scale);
  return {frame, T_F_S, Solid::box(bounds.sizes().cwiseProduct(scale.cwiseAbs()))};
}

BodyPart partOf(const std::string& frame, const urdf::Pose& origin, const urdf::Geometry& geometry) {
  const Pose T_F_S = poseOf(origin);
  switch (geometry.type) {
    case urdf::Geometry::BOX: {
      const auto& size = dynamic_cast<const urdf::Box&>(geometry).dim;
      return {frame, T_F_S, Solid::box({size.x, size.y, size.z})};
    }
    case urdf::Geometry::SPHERE:
      return {frame, T_F_S, Solid::sphere(dynamic_cast<const urdf::Sphere&>(geometry).radius)};
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(geometry);
      return {frame, T_F_S, Solid::cylinder(cylinder.radius, cylinder.length)};
    }
    default:
      return partOfMesh(frame, T_F_S, dynamic_cast<const urdf::Mesh&>(geometry));
  }
}

template <class Elements>
void addParts(const std::string& frame, const Elements& elements, std::vector<BodyPart>& parts) {
  for (const auto& element : elements) {
    if (element->geometry != nullptr) parts.push_back(partOf(frame, element->origin, *element->geometry));
  }
}

}  // namespace

std::vector<BodyPart> partsOfRobot(const std::string& urdf) {
  urdf::Model model;
  check(model.initString(urdf), "it is no URDF; the lines before say why");
  std::vector<BodyPart> parts;
  for (const auto& [name, link] : model.links_) {
    if (link->collision_array.empty()) {
      addParts(name, link->visual_array, parts);
    } else {
      addParts(name, link->collision_array, parts);
    }
  }
  check(!parts.empty(), "no link of the URDF has a shape");
  return parts;
}

}  // namespace depth_fusion
