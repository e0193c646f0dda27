#include "depth_fusion/preprocessing/depth_preprocessor.h"

#include <algorithm>
#include <cmath>

#include "depth_fusion/common/error.h"
#include "depth_fusion/compute/device_image.h"
#include "depth_fusion/preprocessing/depth_correction.h"
#include "depth_fusion/preprocessing/depth_range.h"
#include "depth_fusion/preprocessing/sensor_noise.h"
#include "preprocessing/preprocessing_kernels.h"

namespace depth_fusion {
namespace {

// Returns the number of tiles along an axis.
size_t tiles(int pixels) { return (pixels + DEPTH_TILE - 1) / DEPTH_TILE; }

SensorMotionArgs sensorMotion(const Vector6d& velocity, const PreprocessingParameters& parameters) {
  SensorMotionArgs motion{{}, {}, parameters.readout_s, parameters.stamp_delay_s};
  for (int i = 0; i < 3; ++i) {
    motion.rotation_rad_s[i] = static_cast<float>(velocity[i]);
    motion.velocity_m_s[i] = static_cast<float>(velocity[3 + i]);
  }
  return motion;
}

// The parameters, with the range limited to what the sensor's noise allows.
PreprocessingParameters limited(PreprocessingParameters parameters, const DepthSensorParameters& sensor) {
  validateRange(parameters, sensor);
  parameters.max_range_m = depthRange(parameters, sensor).max_m;
  return parameters;
}

bool sameNoise(const DepthSensorParameters& a, const DepthSensorParameters& b) {
  return a.sigma_base_m == b.sigma_base_m && a.sigma_growth_per_m == b.sigma_growth_per_m &&
         a.sigma_from_m == b.sigma_from_m;
}

const CameraIntrinsics& checked(const CameraIntrinsics& camera) {
  check(camera.valid(),
        "the depth camera's intrinsics are not valid; give them with --intrinsics fx,fy,cx,cy");
  check(std::min(camera.width, camera.height) >> (DepthFrame::kLevels - 1) > 2,
        "depth images of " + sizeText(camera.width, camera.height) + " are too small");
  return camera;
}

std::shared_ptr<DepthFrame> makeResult(ComputeContext& compute, CameraIntrinsics camera) {
  auto result = std::make_shared<DepthFrame>();
  result->raw_depth = zeroImage(compute, camera);
  result->measurements = zeroImage(compute, camera);
  result->max_tiles =
      DeviceBuffer(compute, sizeof(float) * tiles(camera.width) * tiles(camera.height), "depth tiles");
  for (int level = 0; level < DepthFrame::kLevels; ++level) {
    result->levels.push_back({camera, zeroImage(compute, camera), zeroImage(compute, camera)});
    camera = halved(camera);
  }
  return result;
}

}  // namespace

struct DepthPreprocessor::Kernels : PreprocessingKernels {
  using PreprocessingKernels::PreprocessingKernels;
};

DepthPreprocessor::DepthPreprocessor(ComputeContext& compute, const PreprocessingParameters& parameters,
                                     const CameraIntrinsics& camera, const DepthSensorParameters& sensor)
    : compute_(compute),
      parameters_(limited(parameters, sensor)),
      sensor_(sensor),
      results_([&compute, camera = checked(camera)] { return makeResult(compute, camera); }),
      kernels_(std::make_unique<Kernels>(compute)) {
  const size_t pixels = static_cast<size_t>(camera.width) * camera.height;
  input_ = DeviceBuffer(compute, (pixels + 16) * sizeof(float), "the depth image");
  skewed_depth_ = zeroImage(compute, camera);
  uploadOffsets();
}

DepthPreprocessor::~DepthPreprocessor() = default;

void DepthPreprocessor::setParameters(const PreprocessingParameters& parameters,
                                      const DepthSensorParameters& sensor) {
  const bool new_offsets = parameters.depth_offsets_per_m != parameters_.depth_offsets_per_m;
  parameters_ = limited(parameters, sensor);
  if (!sameNoise(sensor, sensor_)) noise_.reset();
  sensor_ = sensor;
  if (new_offsets) uploadOffsets();
}

const DepthFrame& DepthPreprocessor::process(const RgbdFrame& frame, const Vector6d& velocity) {
  DepthFrame& result = *results_.next();
  result.depth_step_m = parameters_.max_range_m / MEASUREMENT_DEPTH_MAX;
  const CameraIntrinsics& camera = result.levels[0].camera;
  const bool is_u16 = frame.depth.type() == CV_16UC1;
  check(is_u16 || frame.depth.type() == CV_32FC1, "depth images must hold 16-bit integers or 32-bit floats");
  check(!distorts(frame.distortion), "a depth image's lens distortion is still in it; see FrameRegistration");
  check(frame.depth.cols == camera.width && frame.depth.rows == camera.height,
        "a depth image is " + sizeText(frame.depth.cols, frame.depth.rows) + ", the intrinsics are for " +
            sizeText(camera.width, camera.height));
  if (!noise_) noise_ = raisedToNoise(frame, {parameters_.min_range_m, parameters_.max_range_m}, sensor_);
  for (DepthLevel& level : result.levels) level.sensor = noise_.value_or(sensor_);
  const cv::Mat depth = frame.depth.isContinuous() ? frame.depth : frame.depth.clone();
  input_.write(depth.data, depth.total() * depth.elemSize());

  const float sigma_px = parameters_.bilateral_sigma_px;
  BilateralArgs bilateral{{}, parameters_.bilateral_cutoff_sigmas};
  for (int i = 0; i < 3; ++i)
    bilateral.spatial_weights[i] = std::exp(static_cast<float>(-i * i) / (2.0f * sigma_px * sigma_px));

  const bool compensates =
      !velocity.isZero() && (parameters_.readout_s != 0.0f || parameters_.stamp_delay_s != 0.0f);
  kernels_->depthToMetres(
      is_u16, input_, offsets_, compensates ? skewed_depth_ : result.raw_depth, camera,
      {static_cast<float>(frame.depth_unit_m), parameters_.min_range_m, parameters_.max_range_m});
  if (compensates) {
    kernels_->compensateMotion(skewed_depth_, result.raw_depth, camera, sensorMotion(velocity, parameters_));
  }
  kernels_->maxTiles(result.raw_depth, result.max_tiles, camera);
  kernels_->filterBilateral(result.raw_depth, result.levels[0].depth, camera, toArgs(result.levels[0].sensor),
                            bilateral);
  for (int i = 0; i < DepthFrame::kLevels; ++i) {
    DepthLevel& level = result.levels[i];
    if (i > 0) kernels_->halveDepth(result.levels[i - 1], level, parameters_.bilateral_cutoff_sigmas);
    kernels_->computeNormals(level.depth, level.normals, level.camera, parameters_.max_relative_step);
  }
  uploadWeights(frame.weights);
  const DeviceBuffer none;
  kernels_->packMeasurements(result, frame.weights.empty() ? none : weights_, result.measurements);
  return result;
}

const DepthFrame& DepthPreprocessor::process(const RgbdFrame& frame, const Vector6d& velocity,
                                             StageTimers& timers) {
  const StageTimers::Scope timer(timers, "preprocessing");
  const DepthFrame& result = process(frame, velocity);
  compute_.finish();
  return result;
}

void DepthPreprocessor::uploadOffsets() {
  offsets_ = DeviceBuffer();
  const cv::Mat grid = parseDepthOffsets(parameters_.depth_offsets_per_m);
  if (grid.empty()) return;
  const CameraIntrinsics& camera = results_.current()->levels[0].camera;
  offsets_ = zeroImage(compute_, camera);
  writeImage(offsets_, camera, spreadOffsets(grid, {camera.width, camera.height}));
}

void DepthPreprocessor::uploadWeights(const cv::Mat& weights) {
  if (weights.empty()) return;
  const CameraIntrinsics& camera = results_.current()->levels[0].camera;
  check(weights.type() == CV_32FC1, "the weights of depth pixels must be 32-bit floats");
  check(weights.cols == camera.width && weights.rows == camera.height,
        "a map of weights is " + sizeText(weights.cols, weights.rows) + ", its depth image " +
            sizeText(camera.width, camera.height));
  if (weights_.bytes() == 0) weights_ = zeroImage(compute_, camera);
  writeImage(weights_, camera, weights);
}

}  // namespace depth_fusion
