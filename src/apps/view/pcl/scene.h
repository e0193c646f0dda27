// What PCL's window shows.
#pragma once

#include <pcl/visualization/pcl_visualizer.h>
#include <vtkPolyData.h>
#include <vtkTexture.h>

#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "apps/view/model.h"
#include "apps/view/ruler.h"
#include "apps/view/window.h"

namespace depth_fusion {

struct SceneOptions {
  std::string paint;  // one that the model has
  bool behind = false;
  bool way = true;
};

class ModelScene {
 public:
  // A window of that size, on the screen or, for a screenshot, in memory.
  explicit ModelScene(const WindowOptions& options);

  // Takes the place of what was shown before.
  void show(const ViewedModel& model, const SceneOptions& options, const Ruler& ruler);
  // The picture that the window has now, CV_8UC3 BGR.
  cv::Mat picture();

  // Looks at the whole model, upright, by a name of viewNames().
  void lookFrom(const std::string& view, const TriangleMesh& mesh);
  // The camera turns about what is so far in front of it.
  void look(const Pose& T_W_C, double distance_m);
  // The point of the surface at a pixel, counted from the lower left corner; nothing where there is none.
  std::optional<Eigen::Vector3d> pointAt(int x, int y);

  pcl::visualization::PCLVisualizer& viewer() { return viewer_; }

 private:
  void addTextured(const std::string& name, vtkPolyData& data, vtkTexture& texture);
  vtkProperty& propertyOf(const std::string& shape);
  void showSurface(const std::string& name, const SceneOptions& options);
  vtkRenderer& renderer() { return *viewer_.getRendererCollection()->GetFirstRenderer(); }
  void show(const Ruler& ruler);
  // All that is not the model.
  void showOthers(bool visible);

  const WindowOptions& options_;
  pcl::visualization::PCLVisualizer viewer_;
};

}  // namespace depth_fusion
