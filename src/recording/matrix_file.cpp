#include "recording/matrix_file.h"

#include <algorithm>
#include <cmath>

#include "common/io/text_file.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {

std::vector<double> readMatrixFile(const std::string& path, size_t size) {
  std::string text;
  for (const TextLine& line : readTextLines(path)) text += line.text + ' ';
  const auto numbers = parseNumbers(text);
  check(numbers && numbers->size() == size * size,
        path + ": expected a matrix of " + std::to_string(size) + "x" + std::to_string(size) + " numbers");
  return *numbers;
}

std::optional<Pose> readPoseFile(const std::string& path) {
  constexpr double kRotationTolerance = 1e-2;
  const std::vector<double> numbers = readMatrixFile(path, 4);
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
