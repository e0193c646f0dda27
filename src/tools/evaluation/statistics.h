// What is said of a set of errors.
#pragma once

#include <cstddef>
#include <vector>

namespace depth_fusion {

struct ErrorStatistics {
  size_t count = 0;
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;
  double percentile95 = 0.0;
  double max = 0.0;
};

// Every figure is zero if there are no errors.
ErrorStatistics statisticsOf(const std::vector<double>& errors);

}  // namespace depth_fusion
