// The distance between two points that are picked.
#pragma once

#include <Eigen/Core>
#include <cstdio>
#include <string>
#include <vector>

namespace depth_fusion {

class Ruler {
 public:
  // The third point begins anew.
  void pick(const Eigen::Vector3d& point_W) {
    if (points_W_.size() == 2) points_W_.clear();
    points_W_.push_back(point_W);
  }
  void clear() { points_W_.clear(); }

  const std::vector<Eigen::Vector3d>& points_W() const { return points_W_; }

  // What there is to say, as "0.731 m".
  std::string text() const {
    if (points_W_.empty()) return "";
    char text[96];
    const Eigen::Vector3d& p_W = points_W_.front();
    if (points_W_.size() == 1)
      std::snprintf(text, sizeof(text), "(%.3f, %.3f, %.3f) m, and to?", p_W.x(), p_W.y(), p_W.z());
    else
      std::snprintf(text, sizeof(text), "%.3f m", (points_W_[1] - p_W).norm());
    return text;
  }

 private:
  std::vector<Eigen::Vector3d> points_W_;
};

}  // namespace depth_fusion
