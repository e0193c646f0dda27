#pragma once

#include <vector>

namespace depth_fusion {

// Nearest-rank percentile of the samples (fraction in [0, 1]); 0 without samples.
double percentile(std::vector<double> samples, double fraction);

}  // namespace depth_fusion
