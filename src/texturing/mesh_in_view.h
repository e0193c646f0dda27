// A mesh as a camera sees it, and what of it is hidden.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "texturing/view_image.h"

namespace depth_fusion {

class MeshInView {
 public:
  // Draws the depth of the mesh. `hidden_ratio`: see TexturingParameters.
  MeshInView(const TriangleMesh& mesh, const TexturingView& view, float hidden_ratio);

  // The pixel and the depth of each vertex; a depth of 0 is behind the camera.
  const std::vector<Eigen::Vector3f>& pixels() const { return pixels_; }

  // Whether a point in the image is not hidden, nor at a pixel beside something that is in front of it.
  bool sees(const Eigen::Vector3f& uvz) const;
  // Whether something lies far behind it a few pixels away: it is at an outline.
  bool isAtOutline(const Eigen::Vector3f& uvz) const;

 private:
  std::vector<Eigen::Vector3f> pixels_;
  cv::Mat nearest_, farthest_;  // depth about each pixel, CV_32FC1; infinite where there is nothing
  float hidden_ratio_;
};

}  // namespace depth_fusion
