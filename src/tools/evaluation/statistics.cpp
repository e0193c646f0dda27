#include "tools/evaluation/statistics.h"

#include <algorithm>
#include <cmath>

#include "depth_fusion/common/percentile.h"

namespace depth_fusion {

ErrorStatistics statisticsOf(const std::vector<double>& errors) {
  if (errors.empty()) return {};
  double sum = 0.0, sum_of_squares = 0.0;
  for (const double error : errors) {
    sum += error;
    sum_of_squares += error * error;
  }
  ErrorStatistics statistics;
  statistics.count = errors.size();
  statistics.mean = sum / static_cast<double>(errors.size());
  statistics.rmse = std::sqrt(sum_of_squares / static_cast<double>(errors.size()));
  statistics.median = percentile(errors, 0.5);
  statistics.percentile95 = percentile(errors, 0.95);
  statistics.max = *std::max_element(errors.begin(), errors.end());
  return statistics;
}

}  // namespace depth_fusion
