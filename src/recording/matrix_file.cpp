#include "recording/matrix_file.h"

#include <algorithm>
#include <cmath>

#include "common/io/text_file.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

std::vector<double> readNumbers(const std::string& path) {
  std::string text;
  for (const TextLine& line : readTextLines(path)) text += withDecimalPoints(line.text) + ' ';
  const auto numbers = parseNumbers(text);
  return numbers.value_or(std::vector<double>());
}

}  // namespace

std::vector<double> readCameraMatrixFile(const std::string& path) {
  std::vector<double> k = readNumbers(path);
  if (k.size() == 12 || k.size() == 16) k = {k[0], k[1], k[2], k[4], k[5], k[6], k[8], k[9], k[10]};
  check(k.size() == 9, path + ": expected a matrix of 3x3 numbers (or of 3x4 or 4x4, that begins with it)");
  return k;
}

std::optional<Pose> readPoseFile(const std::string& path) {
  constexpr double kRotationTolerance = 1e-2;
  std::vector<double> numbers = readNumbers(path);
  if (numbers.size() == 12) numbers.insert(numbers.end(), {0.0, 0.0, 0.0, 1.0});
  check(numbers.size() == 16, path + ": expected a matrix of 4x4 or 3x4 numbers");
  const auto is_finite = [](double number) { return std::isfinite(number); };
  if (!std::all_of(numbers.begin(), numbers.end(), is_finite)) return std::nullopt;
  const Eigen::Matrix4d matrix =
      Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  if (rotation.isZero(0.0)) return std::nullopt;
  check((rotation * rotation.transpose()).isIdentity(kRotationTolerance) && rotation.determinant() > 0.0,
        path + ": the upper left 3x3 matrix is no rotation");
  Pose T_W_D = Pose::Identity();
  T_W_D.linear() = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
  T_W_D.translation() = matrix.topRightCorner<3, 1>();
  return T_W_D;
}

}  // namespace depth_fusion
