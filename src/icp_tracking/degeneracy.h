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
  // threshold: the paper's theta, of the eigenvalues divided by the sum of the matches' weights, which are to
  // be larger by a standard deviation; 0: nothing is free.
  // `judged` decides what is free: the system's hessian, or its structure.
  DegeneracyAnalysis(const IcpSystem& system, const Matrix6d& judged, const Eigen::AlignedBox3d& box,
                     double threshold);

  int freeDirections() const { return free_; }
  // The smallest eigenvalue divided by the sum of the weights.
  double smallestEigenvalue() const { return eigenvalues_(0); }
  // The twist that belongs to it.
  Vector6d weakestTwist() const { return to_shrunk_.transpose() * eigenvectors_.col(0); }
  // The twists of the free directions, in columns.
  Eigen::MatrixXd freeTwists() const { return to_shrunk_.transpose() * eigenvectors_.leftCols(free_); }
  const IcpSystem& system() const { return system_; }
  // The system without what it says about the free directions.
  IcpSystem constrained() const;
  // The solution, which along the free directions takes back the motion `so_far`.
  Vector6d solve(const Vector6d& so_far = Vector6d::Zero()) const;
  // The free directions in words, in the frame of the system: "sliding along x, rotating about z".
  std::string freeDirectionNames() const { return namesUpTo(threshold_); }
  // The name of the direction with the i-th smallest eigenvalue.
  std::string nameOf(int i) const;
  // The same of the directions that would be free by another threshold.
  std::string namesUpTo(double threshold) const;

 private:
  int freeUpTo(double threshold) const;

  Matrix6d to_shrunk_;  // J^ = to_shrunk * J; twists: x = to_shrunk^T * x^
  IcpSystem system_;
  Vector6d eigenvalues_;   // of what is judged, shrunk, ascending, divided by the sum of the weights
  Matrix6d eigenvectors_;  // in columns
  // The eigenvalues' standard deviations: what the normals' noise adds to the hessian, over the root of the
  // number of normals that are independent.
  Vector6d uncertainties_;
  double threshold_;
  Eigen::Vector3d size_;
  int free_ = 0;
};

}  // namespace depth_fusion
