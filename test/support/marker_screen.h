// What a viewer of the surface's markers has on its screen.
#pragma once

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <array>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "depth_fusion/surface_mesh/triangle_mesh.h"
#include "support/nodelet_graph.h"

namespace depth_fusion {

using Triangle = std::array<std::array<float, 3>, 3>;

inline Triangle fromItsLeastCorner(Triangle triangle) {
  std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
  return triangle;
}

inline std::vector<Triangle> trianglesOf(const TriangleMesh& mesh) {
  std::vector<Triangle> triangles;
  for (const MeshTriangle& t : mesh.triangles) {
    Triangle corners;
    for (int i = 0; i < 3; ++i) std::copy_n(mesh.vertices[t[i]].position_W.data(), 3, corners[i].begin());
    triangles.push_back(fromItsLeastCorner(corners));
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

// Shows markers as rviz does on its screen.
class Screen {
 public:
  // `is_told_twice`: what other viewers missed may come once more.
  Screen(ros::NodeHandle& handle, const std::string& topic, bool is_told_twice = false)
      : is_told_twice_(is_told_twice),
        subscriber_(handle.subscribe<visualization_msgs::MarkerArray>(
            topic, 1000, [this](const visualization_msgs::MarkerArray::ConstPtr& message) {
              const std::lock_guard<std::mutex> lock(mutex_);
              for (const visualization_msgs::Marker& marker : message->markers) apply(marker);
            })) {}

  std::vector<Triangle> triangles() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<Triangle> triangles;
    for (const auto& entry : markers_) {
      const auto& points = entry.second.points;
      EXPECT_EQ(points.size() % 3, 0u);
      EXPECT_EQ(entry.second.colors.size(), points.size());
      for (size_t i = 0; i + 2 < points.size(); i += 3) {
        Triangle t;
        for (int corner = 0; corner < 3; ++corner) {
          const geometry_msgs::Point& p = points[i + corner];
          t[corner] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
        }
        triangles.push_back(fromItsLeastCorner(t));
      }
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
  }
  bool shows(const TriangleMesh& mesh) const {
    const std::vector<Triangle> expected = trianglesOf(mesh);
    return eventually([&] { return triangles() == expected; }, 30.0);
  }
  std::map<int, visualization_msgs::Marker> markers() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return markers_;
  }
  // Holds how many markers came since the last call, and how large they were.
  struct Traffic {
    size_t added = 0, deleted = 0, all_deleted = 0, bytes = 0;
  };
  Traffic takeTraffic() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(traffic_, Traffic());
  }

 private:
  void apply(const visualization_msgs::Marker& marker) {
    EXPECT_EQ(marker.ns, "surface");
    EXPECT_EQ(marker.header.frame_id, "map");
    traffic_.bytes += ros::serialization::serializationLength(marker);
    if (marker.action == visualization_msgs::Marker::DELETEALL) {
      ++traffic_.all_deleted;
      markers_.clear();
    } else if (marker.action == visualization_msgs::Marker::DELETE) {
      ++traffic_.deleted;
      EXPECT_TRUE(markers_.erase(marker.id) == 1u || is_told_twice_);
    } else {
      ++traffic_.added;
      EXPECT_EQ(marker.type, +visualization_msgs::Marker::TRIANGLE_LIST);
      EXPECT_EQ(marker.pose.orientation.w, 1.0);
      markers_[marker.id] = marker;
    }
  }

  const bool is_told_twice_;
  mutable std::mutex mutex_;
  std::map<int, visualization_msgs::Marker> markers_;
  Traffic traffic_;
  ros::Subscriber subscriber_;
};

}  // namespace depth_fusion
