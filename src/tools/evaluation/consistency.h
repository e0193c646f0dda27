// Whether errors are as large as their covariances say.
#pragma once

#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/pipeline/drift_parameters.h"

namespace depth_fusion {

// Of a sensor that has noise and no other errors, as those of simulation: measured on 20 runs through `room`
// (docs/covariance.md).
DriftParameters driftOfNoise();

// The normalised estimation error squared: six in the mean, if the covariance is the error's.
double nees(const Vector6d& error, const Matrix6d& covariance);

struct NeesBounds {
  double lower = 0.0, upper = 0.0;

  bool hold(double mean) const { return mean >= lower && mean <= upper; }
};

// Between which 95 % of the means over `runs` independent runs lie (Y. Bar-Shalom, X. Li, T. Kirubarajan,
// "Estimation with Applications to Tracking and Navigation", 2001, section 5.4), to 1 % for five runs or more
// (E. Wilson, M. Hilferty, "The distribution of chi-square", PNAS 1931).
NeesBounds neesBounds(int runs);

}  // namespace depth_fusion
