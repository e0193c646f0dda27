#include "apps/view/pcl/scene.h"

#include <vtkCamera.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWorldPointPicker.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "apps/view/pcl/surface_data.h"
#include "depth_fusion/surface_mesh/mesh_picture.h"
#include "tools/report/level.h"

namespace depth_fusion {
namespace {

constexpr double kFieldOfView_rad = 1.05;  // horizontal
constexpr double kStepBack = 0.15;         // of the distance from which nearly all is seen
constexpr double kRulerEnd_rad = 0.004;    // as large as the ruler's ends look
constexpr char kModel[] = "model";         // what the names of its parts begin with
constexpr char kKeys[] = "n paint   v fly   t way   b behind   shift+click measure   r all   q quit";

}  // namespace

ModelScene::ModelScene(const WindowOptions& options)
    : options_(options), viewer_("depth_fusion: " + options.model, options.screenshot.empty()) {
  viewer_.setBackgroundColor(0.11, 0.125, 0.15);
  viewer_.getRenderWindow()->SetOffScreenRendering(options.screenshot.empty() ? 0 : 1);
  viewer_.setSize(options.width, options.height);
  viewer_.setShowFPS(false);
}

void ModelScene::show(const ViewedModel& model, const SceneOptions& options, const Ruler& ruler) {
  viewer_.removeAllShapes();
  if (options.paint == "texture") {
    for (size_t page = 0; page < model.pages.size(); ++page) {
      const std::string name = kModel + std::to_string(page);
      addTextured(name, *pageData(model, page), *textureOf(model.pages[page]));
      showSurface(name, options);
    }
  } else {
    viewer_.addModelFromPolyData(surfaceData(model, options.paint), kModel);
    showSurface(kModel, options);
  }
  if (options.way && model.way.size() > 1) {
    viewer_.addModelFromPolyData(wayData(model.way), "way");
    propertyOf("way").SetColor(1.0, 0.65, 0.1);
    propertyOf("way").SetLineWidth(2.0f);
    propertyOf("way").SetLighting(false);
  }
  if (options_.screenshot.empty()) viewer_.addText(kKeys, 10, 10, 14, 0.7, 0.75, 0.8, "keys");
  show(ruler);
}

void ModelScene::showSurface(const std::string& name, const SceneOptions& options) {
  vtkProperty& surface = propertyOf(name);
  surface.SetBackfaceCulling(options.behind ? 0 : 1);
  surface.SetLighting(options.paint != "colors" && options.paint != "texture");
  surface.SetAmbient(0.25);
  surface.SetDiffuse(0.75);
  surface.SetPointSize(3.0f);
}

void ModelScene::show(const Ruler& ruler) {
  const Eigen::Vector3d eye_W(renderer().GetActiveCamera()->GetPosition());
  std::vector<pcl::PointXYZ> ends;
  for (const Eigen::Vector3d& p_W : ruler.points_W()) {
    const Eigen::Vector3f p = p_W.cast<float>();
    ends.emplace_back(p.x(), p.y(), p.z());
    viewer_.addSphere(ends.back(), kRulerEnd_rad * (p_W - eye_W).norm(), 1.0, 0.8, 0.3,
                      "end " + std::to_string(ends.size()));
  }
  if (ends.size() == 2) viewer_.addLine(ends[0], ends[1], 1.0, 0.8, 0.3, "ruler");
  if (!ends.empty()) viewer_.addText(ruler.text(), 10, 34, 18, 1.0, 0.8, 0.3, "says");
}

cv::Mat ModelScene::picture() {
  vtkRenderWindow& window = *viewer_.getRenderWindow();
  window.Render();
  const int* size = window.GetSize();
  const auto pixels = vtkSmartPointer<vtkUnsignedCharArray>::New();
  window.GetPixelData(0, 0, size[0] - 1, size[1] - 1, 0, pixels);
  cv::Mat picture;
  cv::flip(cv::Mat(size[1], size[0], CV_8UC3, pixels->GetPointer(0)), picture, 0);
  cv::cvtColor(picture, picture, cv::COLOR_RGB2BGR);
  return picture;
}

void ModelScene::lookFrom(const std::string& view, const TriangleMesh& mesh) {
  const CameraIntrinsics camera = pictureCamera(options_.width, options_.height, kFieldOfView_rad);
  viewer_.setCameraFieldOfView(2.0 * std::atan(0.5 * options_.height / camera.fy));
  const Eigen::Matrix3d R_L_W = levelFrom(mesh);
  Pose T_W_C = Pose(R_L_W.transpose()) * viewOf(rotated(R_L_W, mesh), camera, view);
  Eigen::AlignedBox3f box;
  for (const MeshVertex& vertex : mesh.vertices) box.extend(vertex.position_W);
  const Eigen::Vector3d centre_W = box.center().cast<double>();
  const Eigen::Vector3d forward_W = T_W_C.linear().col(2);
  const double distance_m = (centre_W - T_W_C.translation()).dot(forward_W);
  T_W_C.translation() -= kStepBack * distance_m * forward_W;
  look(T_W_C, (1.0 + kStepBack) * distance_m);
}

void ModelScene::look(const Pose& T_W_C, double distance_m) {
  const Eigen::Vector3d eye = T_W_C.translation(), up = -T_W_C.linear().col(1);
  const Eigen::Vector3d target = eye + distance_m * T_W_C.linear().col(2);
  viewer_.setCameraPosition(eye.x(), eye.y(), eye.z(), target.x(), target.y(), target.z(), up.x(), up.y(),
                            up.z());
  renderer().ResetCameraClippingRange();
}

std::optional<Eigen::Vector3d> ModelScene::pointAt(int x, int y) {
  showOthers(false);
  viewer_.getRenderWindow()->Render();
  const bool is_surface = renderer().GetZ(x, y) < 1.0;
  const auto picker = vtkSmartPointer<vtkWorldPointPicker>::New();
  picker->Pick(x, y, 0.0, &renderer());
  showOthers(true);
  if (!is_surface) return std::nullopt;
  return Eigen::Vector3d(picker->GetPickPosition());
}

void ModelScene::showOthers(bool visible) {
  for (auto& [name, actor] : *viewer_.getShapeActorMap()) {
    if (name.rfind(kModel, 0) != 0) vtkProp::SafeDownCast(actor)->SetVisibility(visible ? 1 : 0);
  }
}

// PCL's own actors, vtkLODActor, draw no textures.
void ModelScene::addTextured(const std::string& name, vtkPolyData& data, vtkTexture& texture) {
  const auto mapper = vtkSmartPointer<vtkPolyDataMapper>::New();
  mapper->SetInputData(&data);
  const auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->SetTexture(&texture);
  renderer().AddActor(actor);
  (*viewer_.getShapeActorMap())[name] = actor;
}

vtkProperty& ModelScene::propertyOf(const std::string& shape) {
  return *vtkActor::SafeDownCast(viewer_.getShapeActorMap()->at(shape))->GetProperty();
}

}  // namespace depth_fusion
