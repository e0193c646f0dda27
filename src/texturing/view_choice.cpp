#include "texturing/view_choice.h"

#include <algorithm>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace depth_fusion {
namespace {

// The mean slope of the brightness, which blur lowers.
double sharpnessOf(const cv::Mat& image) {
  cv::Mat brightness, slope_u, slope_v, slope;
  cv::cvtColor(image, brightness, cv::COLOR_BGR2GRAY);
  cv::Sobel(brightness, slope_u, CV_32F, 1, 0);
  cv::Sobel(brightness, slope_v, CV_32F, 0, 1);
  cv::magnitude(slope_u, slope_v, slope);
  return cv::mean(slope)[0];
}

bool areNear(const TexturingView& a, const TexturingView& b, double distance_m, double angle_rad) {
  const Pose motion = a.T_W_C.inverse() * b.T_W_C;
  return motion.translation().norm() < distance_m && rotationAngle(motion) < angle_rad;
}

// The first, the next one that is not near it, and so on.
std::vector<size_t> spread(const std::vector<TexturingView>& views, const std::vector<size_t>& order,
                           double distance_m, double angle_rad) {
  std::vector<size_t> chosen;
  for (const size_t i : order) {
    const bool is_apart = std::none_of(chosen.begin(), chosen.end(), [&](size_t other) {
      return areNear(views[i], views[other], distance_m, angle_rad);
    });
    if (is_apart) chosen.push_back(i);
  }
  return chosen;
}

}  // namespace

std::vector<ChosenView> chosenViews(std::vector<TexturingView> views, const TexturingParameters& parameters) {
  std::vector<double> sharpness(views.size());
  cv::parallel_for_({0, static_cast<int>(views.size())}, [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) sharpness[i] = sharpnessOf(imageOf(views[i]));
  });
  std::vector<size_t> order(views.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return sharpness[a] > sharpness[b]; });
  double distance_m = static_cast<double>(parameters.view_distance_m);
  double angle_rad = static_cast<double>(parameters.view_angle_rad);
  std::vector<size_t> numbers = spread(views, order, distance_m, angle_rad);
  while (numbers.size() > static_cast<size_t>(parameters.max_views)) {
    constexpr double kWider = 1.2;
    distance_m *= kWider;
    angle_rad *= kWider;
    numbers = spread(views, order, distance_m, angle_rad);
  }
  std::vector<ChosenView> chosen;
  for (const size_t i : numbers) chosen.push_back({std::move(views[i])});
  return chosen;
}

}  // namespace depth_fusion
