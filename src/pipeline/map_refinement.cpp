#include "depth_fusion/pipeline/map_refinement.h"

#include <opencv2/imgcodecs.hpp>

#include "depth_fusion/pipeline/stored_map.h"

namespace depth_fusion {
namespace {

// A view is the mean of many measurements.
DepthSensorParameters ofViews(DepthSensorParameters sensor) {
  constexpr float kLess = 1.0f / 3.0f;
  sensor.sigma_base_m *= kLess;
  sensor.sigma_growth_per_m *= kLess;
  return sensor;
}

}  // namespace

RgbdFrame frameOf(const Keyframe& keyframe) {
  RgbdFrame frame;
  frame.stamp_s = keyframe.stamp_s;
  frame.depth = keyframe.view.depth();
  frame.intrinsics = keyframe.view.camera();
  const std::string& jpeg = keyframe.color.jpeg;
  if (jpeg.empty()) return frame;
  frame.color = cv::imdecode(std::vector<char>(jpeg.begin(), jpeg.end()), cv::IMREAD_UNCHANGED);
  frame.color_intrinsics = keyframe.color.camera;
  frame.T_C_D = keyframe.color.T_C_D;
  return frame;
}

PreprocessingParameters ofViews(PreprocessingParameters parameters) {
  constexpr float kHardlyAny_px = 0.1f;
  parameters.bilateral_sigma_px = kHardlyAny_px;
  parameters.depth_offsets_per_m.clear();
  parameters.readout_s = 0.0f;
  parameters.stamp_delay_s = 0.0f;
  return parameters;
}

MapRefinement::MapRefinement(ComputeContext& compute, const PipelineParameters& parameters)
    : compute_(compute),
      parameters_(parameters),
      map_(compute, parameters_.map),
      submaps_(map_, parameters_.submaps) {}

void MapRefinement::fuse(const Keyframe& keyframe, const Pose& T_W_D) {
  if (keyframe.view.isEmpty()) return;
  const RgbdFrame frame = frameOf(keyframe);
  if (mapper_ == nullptr || !sameCamera(frame.intrinsics, camera_)) {
    camera_ = frame.intrinsics;
    preprocessor_ = std::make_unique<DepthPreprocessor>(compute_, ofViews(parameters_.preprocessing), camera_,
                                                        ofViews(parameters_.depth_sensor));
    mapper_ = std::make_unique<Mapper>(compute_, map_, submaps_, parameters_, camera_);
  }
  StageTimers timers;
  mapper_->fuse(frame, preprocessor_->process(frame), T_W_D, true, timers);
}

SaveReport MapRefinement::save(MapSaver& saver, const CameraIntrinsics& camera, const StampedPose& last_pose,
                               const Keyframes& keyframes) {
  PipelineParameters parameters = parameters_;
  parameters.map = map_.parameters();
  saver.prepare();
  saver.capture(submaps_, descriptionOf(parameters, camera, last_pose), keyframes);
  return saver.write();
}

}  // namespace depth_fusion
