// Normal equations of the calibration's parameters: the offsets of the grid row by row, then the readout.
#pragma once

#include <Eigen/Cholesky>
#include <array>
#include <vector>

namespace depth_fusion {

constexpr int kGridColumns = 8;
constexpr int kGridRows = 6;
constexpr int kReadoutIndex = kGridColumns * kGridRows;
constexpr int kParameterCount = kReadoutIndex + 1;

using ParameterVector = Eigen::Matrix<double, kParameterCount, 1>;
using ParameterMatrix = Eigen::Matrix<double, kParameterCount, kParameterCount>;

// The derivatives of a residual by the few parameters that it depends on.
class SparseRow {
 public:
  struct Entry {
    int parameter;
    double derivative;
  };

  void add(int parameter, double derivative) { entries_[count_++] = {parameter, derivative}; }
  const Entry* begin() const { return entries_.data(); }
  const Entry* end() const { return entries_.data() + count_; }

 private:
  std::array<Entry, 10> entries_;  // two points: four offsets and the readout each
  int count_ = 0;
};

struct NormalEquations {
  ParameterMatrix hessian = ParameterMatrix::Zero();
  ParameterVector gradient = ParameterVector::Zero();

  void add(const NormalEquations& other) {
    hessian += other.hessian;
    gradient += other.gradient;
  }
};

// Adds up residuals that also depend on N unknowns of their own: a pair's relative pose, or a plane.
template <int N>
class LocalSystem {
 public:
  using LocalVector = Eigen::Matrix<double, N, 1>;

  void add(const LocalVector& local, const SparseRow& row, double residual, double weight) {
    local_hessian_.noalias() += weight * local * local.transpose();
    local_gradient_ += weight * residual * local;
    for (const auto& [i, by_i] : row) {
      cross_.col(i) += weight * by_i * local;
      shared_.gradient[i] += weight * by_i * residual;
      for (const auto& [j, by_j] : row) shared_.hessian(i, j) += weight * by_i * by_j;
    }
  }

  // Returns the step of the local unknowns alone.
  LocalVector localStep() const { return -solver().solve(local_gradient_); }

  // The equations of the shared parameters, with the local unknowns always at their best.
  NormalEquations eliminated() const {
    const auto by_local = solver();
    NormalEquations result = shared_;
    result.hessian.noalias() -= cross_.transpose() * by_local.solve(cross_);
    result.gradient.noalias() -= cross_.transpose() * by_local.solve(local_gradient_);
    return result;
  }

 private:
  using LocalMatrix = Eigen::Matrix<double, N, N>;

  Eigen::LDLT<LocalMatrix> solver() const {
    return Eigen::LDLT<LocalMatrix>(local_hessian_ + 1e-9 * local_hessian_.trace() * LocalMatrix::Identity());
  }

  LocalMatrix local_hessian_ = LocalMatrix::Zero();
  LocalVector local_gradient_ = LocalVector::Zero();
  Eigen::Matrix<double, N, kParameterCount> cross_ = Eigen::Matrix<double, N, kParameterCount>::Zero();
  NormalEquations shared_;
};

// Returns Tukey's biweight of a residual, which is given in its standard deviations.
inline double tukeyWeight(double sigmas, double cutoff_sigmas) {
  const double part = sigmas / cutoff_sigmas;
  const double rest = 1.0 - part * part;
  return rest > 0.0 ? rest * rest : 0.0;
}

}  // namespace depth_fusion
