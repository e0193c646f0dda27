// Finds the directions of motion that the geometry leaves free (the paper's section "Cooperation with CPU
// Registration").
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "icp_tracking/icp_system.h"

namespace depth_fusion {

// The ICP system in coordinates shrunk to the unit cube: with m the centre and S the sizes of the box around
// the points, c^ = S^-1 (c - m x n), whose matrix has eigenvalues of one scale. Twists go back by r = S^-1
// r^, t = t^ - r x m (the paper prints r = S r^, t = t^ + r x m, which does not keep c . r + n . t).
class DegeneracyAnalysis {
 public:
  // threshold: the paper's theta, of the eigenvalues divided by the sum of the matches' weights.
  DegeneracyAnalysis(const IcpSystem& system, const Eigen::AlignedBox3d& box, double threshold);

  int freeDirections() const { return free_; }
  // The smallest eigenvalue divided by the sum of the weights.
  double smallestEigenvalue() const { return eigenvalues_(0); }
  // The system without what it says about the free directions.
  IcpSystem constrained() const;
  // The solution with no motion along the free directions.
  Vector6d solve() const;
  // The free directions in words, in the frame of the system: "sliding along x, rotating about z".
  std::string freeDirectionNames() const { return namesUpTo(threshold_); }
  // The same of the directions that would be free by another threshold.
  std::string namesUpTo(double threshold) const;

 private:
  Matrix6d to_shrunk_;  // J^ = to_shrunk * J; twists: x = to_shrunk^T * x^
  IcpSystem system_;
  Vector6d eigenvalues_;   // ascending, divided by the sum of the weights
  Matrix6d eigenvectors_;  // of the shrunk system, in columns
  Vector6d shrunk_gradient_;
  double weights_ = 0.0, threshold_;
  Eigen::Vector3d size_;
  int free_ = 0;
};

}  // namespace depth_fusion
