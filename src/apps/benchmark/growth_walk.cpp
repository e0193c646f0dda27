#include "apps/benchmark/growth_walk.h"

#include <cmath>

#include "depth_fusion/common/error.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

constexpr double kFps = 30.0;
constexpr double kDepthUnit_m = 0.001;
constexpr int kTriesToEnter = 3;

}  // namespace

std::vector<RgbdFrame> roomViews(int width, size_t count) {
  SimulationOptions options;
  options.frames = static_cast<int>(count);
  options.fps = kFps;
  const CameraIntrinsics camera = kinectSensor().camera;
  const double scale = static_cast<double>(width) / camera.width;
  const int height = static_cast<int>(std::lround(camera.height * scale));
  options.intrinsics = {
      width, height, camera.fx * scale, camera.fy * scale, 0.5 * (width - 1), 0.5 * (height - 1)};
  SimulatedRecording recording(options);
  std::vector<RgbdFrame> views;
  while (std::optional<RgbdFrame> view = recording.next()) {
    view->depth.convertTo(view->depth, CV_16UC1, 1.0 / kDepthUnit_m);
    view->depth_unit_m = kDepthUnit_m;
    view->color.release();
    views.push_back(std::move(*view));
  }
  return views;
}

GrowthWalk::GrowthWalk(ComputeContext& compute, const PipelineParameters& parameters,
                       const std::vector<RgbdFrame>& views)
    : views_(views), pipeline_(compute, parameters, views.front().intrinsics) {
  pipeline_.processFrame(frameOf(0));  // the origin of W
}

void GrowthWalk::enter(const Eigen::Vector3d& room_W) {
  Pose T_W_D = Pose::Identity();
  T_W_D.translation() = room_W;
  pipeline_.processFrame(frameOf(0), T_W_D);
  // Against the view of the room before, the first frame is lost; the next is found where the pose was given.
  TrackingStatus status = TrackingStatus::kLost;
  for (int i = 0; i < kTriesToEnter && status == TrackingStatus::kLost; ++i) {
    status = pipeline_.processFrame(frameOf(0)).tracking.status;
  }
  check(status != TrackingStatus::kLost, "the walk does not find into a room");
  startTiming();
}

void GrowthWalk::look(size_t view) {
  const FrameResult result = pipeline_.processFrame(frameOf(view));
  check(result.fusion.blocks_allocated == result.fusion.blocks_requested,
        "the walk has filled the map's pool of blocks; walk fewer --frames");
  lost_ += result.tracking.status == TrackingStatus::kLost;
  updated_blocks_ += result.fusion.blocks_updated;
  ++timed_frames_;
}

void GrowthWalk::lookForth() {
  for (size_t view = 0; view < views_.size(); ++view) look(view);
}

void GrowthWalk::lookBack() {
  for (size_t view = views_.size(); view-- > 0;) look(view);
}

void GrowthWalk::startTiming() {
  pipeline_.timers().clear();
  timed_frames_ = updated_blocks_ = 0;
}

RgbdFrame GrowthWalk::frameOf(size_t view) {
  RgbdFrame frame = views_[view];
  frame.stamp_s = static_cast<double>(++frames_) / kFps;
  return frame;
}

}  // namespace depth_fusion
