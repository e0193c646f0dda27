#include "depth_fusion/registration/frame_registration.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "depth_fusion/common/error.h"
#include "depth_fusion/compute/device_image.h"
#include "registration/registration_kernels.h"

namespace depth_fusion {
namespace {

// A depth pixel finer than this many of the depth camera's would only repeat it.
constexpr double kFinestPixel = 1.5;

bool movesDepth(const RgbdFrame& frame, const RegistrationParameters& parameters) {
  return parameters.depth_to_color && (frame.T_C_D || frame.color_intrinsics);
}

bool changesDepth(const RgbdFrame& frame, const RegistrationParameters& parameters) {
  return distorts(frame.distortion) || movesDepth(frame, parameters);
}

void checkFrame(const RgbdFrame& frame) {
  const CameraIntrinsics& camera = frame.intrinsics;
  check(camera.valid(), "the depth camera's intrinsics are not valid");
  check(frame.depth.cols == camera.width && frame.depth.rows == camera.height,
        "a depth image is " + sizeText(frame.depth.cols, frame.depth.rows) + ", its intrinsics are for " +
            sizeText(camera.width, camera.height));
  check(frame.depth.type() == CV_16UC1 || frame.depth.type() == CV_32FC1,
        "depth images must hold 16-bit integers or 32-bit floats");
  check(frame.weights.empty(),
        "depth with weights cannot be rectified or moved; give it rectified and registered");
}

}  // namespace

bool needsRegistration(const RgbdFrame& frame, const RegistrationParameters& parameters) {
  return changesDepth(frame, parameters) || (!frame.color.empty() && distorts(frame.color_distortion));
}

RgbdFrame withDepthUnit(const RgbdFrame& frame, const RegistrationParameters& parameters) {
  RgbdFrame result = frame;
  if (parameters.depth_unit_m > 0.0f && frame.depth.type() == CV_16UC1)
    result.depth_unit_m = parameters.depth_unit_m;
  result.depth_unit_m *= parameters.depth_scale;
  return result;
}

CameraIntrinsics registeredCamera(const CameraIntrinsics& color_camera,
                                  const CameraIntrinsics& depth_camera) {
  CameraIntrinsics camera = color_camera;
  while (camera.fx > kFinestPixel * depth_camera.fx) camera = halved(camera);
  return camera;
}

// The depth camera's images on the device, and the camera that its depth is moved to.
struct FrameRegistration::Depth {
  RegistrationKernels kernels;
  CameraIntrinsics camera, other_camera;
  LensDistortion distortion;
  LensArgs lens{};
  DeviceBuffer input, metres, rectified, splatted, registered;

  explicit Depth(ComputeContext& compute) : kernels(compute) {}

  void prepare(ComputeContext& compute, const RgbdFrame& frame) {
    if (sameCamera(camera, frame.intrinsics) && distortion == frame.distortion) return;
    lens = lensArgs(frame.intrinsics, frame.distortion, "the depth camera");
    camera = frame.intrinsics;
    distortion = frame.distortion;
    const size_t pixels = static_cast<size_t>(camera.width) * camera.height;
    input = DeviceBuffer(compute, (pixels + 16) * sizeof(float), "the depth image");
    metres = zeroImage(compute, camera);
    rectified = zeroImage(compute, camera);
  }

  void prepareOther(ComputeContext& compute, const CameraIntrinsics& registered_camera) {
    if (sameCamera(other_camera, registered_camera)) return;
    other_camera = registered_camera;
    splatted = zeroImage(compute, other_camera);
    registered = zeroImage(compute, other_camera);
  }

  void upload(const RgbdFrame& frame) {
    const cv::Mat depth = frame.depth.isContinuous() ? frame.depth : frame.depth.clone();
    input.write(depth.data, depth.total() * depth.elemSize());
    kernels.depthToMetres(depth.type() == CV_16UC1, input, metres, camera,
                          static_cast<float>(frame.depth_unit_m));
  }
};

// Where the pixels of the rectified colour image lie in the one that the lens distorts.
struct FrameRegistration::Color {
  CameraIntrinsics camera;
  LensDistortion distortion;
  cv::Mat sources, fractions;  // fixed point

  void prepare(const RgbdFrame& frame) {
    const CameraIntrinsics color_camera = colorCamera(frame);
    if (sameCamera(camera, color_camera) && distortion == frame.color_distortion) return;
    checkDistortion(frame.color_distortion);
    maxSquaredRadius(color_camera, frame.color_distortion, "the colour camera");
    camera = color_camera;
    distortion = frame.color_distortion;
    const cv::Matx33d matrix(camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0);
    cv::Mat pixels;
    cv::initUndistortRectifyMap(matrix, distortion, cv::noArray(), matrix, {camera.width, camera.height},
                                CV_32FC2, pixels, cv::noArray());
    cv::convertMaps(pixels, cv::noArray(), sources, fractions, CV_16SC2);
  }

  cv::Mat rectified(const cv::Mat& color) const {
    cv::Mat result;
    cv::remap(color, result, sources, fractions, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
    return result;
  }
};

FrameRegistration::FrameRegistration(ComputeContext& compute, const RegistrationParameters& parameters)
    : compute_(compute), parameters_(parameters) {
  validate(parameters_.table());
}

FrameRegistration::~FrameRegistration() = default;

void FrameRegistration::setParameters(const RegistrationParameters& parameters) {
  validate(RegistrationParameters(parameters).table());
  parameters_ = parameters;
}

// Colour that cannot be rectified costs the frame its colour, not its depth.
void FrameRegistration::rectifyColor(RgbdFrame& frame) {
  if (!frame.color.empty() && distorts(frame.color_distortion) && colorProblem(frame).empty()) {
    try {
      if (!color_) color_ = std::make_unique<Color>();
      color_->prepare(frame);
      frame.color = color_->rectified(frame.color);
    } catch (const Error& error) {
      frame.color.release();
      frame.color_problem = error.what();
    }
  }
  frame.color_distortion.clear();
}

RgbdFrame FrameRegistration::process(const RgbdFrame& frame) {
  RgbdFrame result = withDepthUnit(frame, parameters_);
  rectifyColor(result);
  if (!changesDepth(frame, parameters_)) return result;
  checkFrame(frame);
  if (!depth_) depth_ = std::make_unique<Depth>(compute_);
  depth_->prepare(compute_, frame);
  depth_->upload(result);
  depth_->kernels.rectify(depth_->metres, depth_->rectified, depth_->camera, depth_->lens,
                          parameters_.max_relative_step);
  result.distortion.clear();
  result.depth_unit_m = 1.0;
  if (!movesDepth(frame, parameters_)) {
    result.depth = readImage(depth_->rectified, depth_->camera);
    return result;
  }
  const Pose T_C_D = frame.T_C_D.value_or(Pose::Identity());
  depth_->prepareOther(compute_, registeredCamera(colorCamera(frame), frame.intrinsics));
  depth_->kernels.registerDepth(depth_->metres, depth_->rectified, depth_->splatted, depth_->registered,
                                depth_->camera, depth_->lens, depth_->other_camera, T_C_D,
                                parameters_.max_relative_step);
  result.depth = readImage(depth_->registered, depth_->other_camera);
  result.intrinsics = depth_->other_camera;
  result.T_C_D.reset();
  if (sameCamera(colorCamera(frame), result.intrinsics)) result.color_intrinsics.reset();
  if (frame.T_W_D) result.T_W_D = *frame.T_W_D * T_C_D.inverse();
  return result;
}

}  // namespace depth_fusion
