#include "depth_fusion/evaluation/statistics.h"

#include <algorithm>
#include <cmath>

namespace depth_fusion {
namespace {

double nearestRank(const std::vector<double>& sorted, double fraction) {
  const double rank = std::ceil(fraction * static_cast<double>(sorted.size()));
  return sorted[static_cast<size_t>(std::max(rank, 1.0)) - 1];
}

}  // namespace

ErrorStatistics statisticsOf(const std::vector<double>& errors) {
  if (errors.empty()) return {};
  std::vector<double> sorted = errors;
  std::sort(sorted.begin(), sorted.end());
  double sum = 0.0, sum_of_squares = 0.0;
  for (const double error : sorted) {
    sum += error;
    sum_of_squares += error * error;
  }
  ErrorStatistics statistics;
  statistics.count = sorted.size();
  statistics.mean = sum / static_cast<double>(sorted.size());
  statistics.rmse = std::sqrt(sum_of_squares / static_cast<double>(sorted.size()));
  statistics.median = nearestRank(sorted, 0.5);
  statistics.percentile95 = nearestRank(sorted, 0.95);
  statistics.max = sorted.back();
  return statistics;
}

}  // namespace depth_fusion
