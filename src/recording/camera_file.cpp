#include "recording/camera_file.h"

#include <yaml-cpp/yaml.h>

#include <limits>
#include <set>
#include <sstream>

#include "common/io/text_file.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

const std::set<std::string> kKeys = {"width", "height", "fx", "fy", "cx", "cy", "depth_scale"};

double readNumber(const YAML::Node& root, const std::string& key) {
  check(root[key].IsDefined(), "'" + key + "' is missing");
  try {
    return root[key].as<double>();
  } catch (const YAML::Exception&) {
    throw Error("'" + key + "' is not a number");
  }
}

std::optional<double> readDepthScale(const YAML::Node& root) {
  if (!root["depth_scale"].IsDefined()) return std::nullopt;
  const double scale = readNumber(root, "depth_scale");
  check(scale > 0.0, "'depth_scale' must be positive");
  return scale;
}

CameraFile parseCamera(const YAML::Node& root) {
  for (const auto& entry : root) {
    const std::string key = entry.first.as<std::string>();
    check(kKeys.count(key) == 1, "unknown key '" + key + "'");
  }
  CameraFile file;
  file.camera.width = static_cast<int>(readNumber(root, "width"));
  file.camera.height = static_cast<int>(readNumber(root, "height"));
  file.camera.fx = readNumber(root, "fx");
  file.camera.fy = readNumber(root, "fy");
  file.camera.cx = readNumber(root, "cx");
  file.camera.cy = readNumber(root, "cy");
  file.depth_scale = readDepthScale(root);
  return file;
}

std::vector<double> readMatrix(const YAML::Node& root, const std::string& key,
                               const std::set<size_t>& sizes) {
  std::vector<double> numbers;
  try {
    numbers = root[key]["data"].as<std::vector<double>>();
  } catch (const YAML::Exception&) {
    throw Error("'" + key + "' has no 'data' with numbers");
  }
  check(sizes.count(numbers.size()) == 1, "'" + key + "' has " + std::to_string(numbers.size()) + " numbers");
  return numbers;
}

Pose readPose(const YAML::Node& root, const std::string& key) {
  constexpr double kTolerance = 1e-4;
  const std::vector<double> numbers = readMatrix(root, key, {16});
  const Eigen::Matrix4d matrix =
      Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  check((rotation * rotation.transpose()).isIdentity(kTolerance) && rotation.determinant() > 0.0 &&
            matrix.row(3).isApprox(Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)),
        "'" + key + "' is no rigid motion");
  Pose pose = Pose::Identity();
  pose.linear() = rotation;
  pose.translation() = matrix.topRightCorner<3, 1>();
  return orthonormalized(pose);
}

CameraFile parseRosCalibration(const YAML::Node& root) {
  CameraFile file;
  const std::vector<double> k = readMatrix(root, "camera_matrix", {9});
  file.camera = {static_cast<int>(readNumber(root, "image_width")),
                 static_cast<int>(readNumber(root, "image_height")),
                 k[0],
                 k[4],
                 k[2],
                 k[5]};
  const std::string model =
      root["distortion_model"].IsDefined() ? root["distortion_model"].as<std::string>() : "";
  check(model == "plumb_bob" || model == "rational_polynomial",
        "'distortion_model' is '" + model + "'; known are plumb_bob and rational_polynomial");
  file.distortion = readMatrix(root, "distortion_coefficients", {4, 5, 8, 12, 14});
  file.depth_scale = readDepthScale(root);
  if (root["depth_to_color"].IsDefined()) file.T_C_D = readPose(root, "depth_to_color");
  return file;
}

}  // namespace

CameraFile readCameraFile(const std::string& path) {
  try {
    const YAML::Node root = YAML::LoadFile(path);
    check(root.IsMap(), "expected lines 'key: number' for width, height, fx, fy, cx, cy");
    return root["camera_matrix"].IsDefined() ? parseRosCalibration(root) : parseCamera(root);
  } catch (const std::exception& error) {
    throw Error(path + ": " + error.what());
  }
}

void writeCameraFile(const std::string& path, const CameraFile& file) {
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  text << "width: " << file.camera.width << "\nheight: " << file.camera.height << "\nfx: " << file.camera.fx
       << "\nfy: " << file.camera.fy << "\ncx: " << file.camera.cx << "\ncy: " << file.camera.cy
       << "\ndepth_scale: " << file.depth_scale.value_or(kTumDepthScale) << '\n';
  writeText(path, text.str());
}

}  // namespace depth_fusion
