// A simulated depth sensor with systematic errors that are known exactly, moved about the room's table as for
// calibration.
#pragma once

#include <functional>
#include <opencv2/core.hpp>

#include "tools/calibration/depth_calibration.h"
#include "tools/simulation/scene_library.h"

namespace depth_fusion {

struct SensorFaults {
  // Says what the inverse depth lacks (1/m) at (x, y), which go from 0 to 1 over the image.
  std::function<double(double x, double y)> offset_per_m = [](double, double) { return 0.0; };
  double readout_s = 0.0;  // of the rolling shutter; the last row is exposed at the stamp
};

class FaultySensor {
 public:
  FaultySensor(const CameraIntrinsics& camera, const SensorFaults& faults)
      : scene_(makeScene("room")), camera_(camera), faults_(faults) {}

  // The sensor moves half a metre to and fro, left and right, up and down.
  Pose poseAt(double time_s) const {
    const GazePath path = [](const Sway& walk, const Sway& look) {
      Gaze gaze;
      gaze.eye_W = {-0.9 + 0.4 * walk(0, 5.0), -0.2 + 0.5 * walk(1, 4.0), 1.5 + 0.3 * walk(2, 3.0)};
      gaze.target_W = {0.7 + 0.3 * look(3, 6.0), 0.3 + 0.5 * look(4, 5.0), 0.6 + 0.4 * look(5, 4.0)};
      return gaze;
    };
    return handHeldPose(path, 1, {}, time_s);
  }

  // Returns the velocity of D in its own frame: rotation (rad/s), translation (m/s).
  Vector6d velocityAt(double time_s) const {
    constexpr double kStep_s = 0.005;
    return twistFromPose(poseAt(time_s - kStep_s).inverse() * poseAt(time_s + kStep_s)) / (2.0 * kStep_s);
  }

  RgbdFrame frameAt(double time_s, uint64_t seed) const {
    const RenderedView view =
        faults_.readout_s == 0.0 ? render(scene_.surface, camera_, poseAt(time_s)) : rolling(time_s);
    RgbdFrame frame;
    frame.stamp_s = time_s;
    frame.intrinsics = camera_;
    frame.color = view.color;
    frame.depth = senseDepth(view, scene_.sensor, seed);
    spoil(frame.depth);
    return frame;
  }

 private:
  RenderedView rolling(double time_s) const {
    RenderedView whole{cv::Mat(camera_.height, camera_.width, CV_32FC1),
                       cv::Mat(camera_.height, camera_.width, CV_8UC3),
                       cv::Mat(camera_.height, camera_.width, CV_32FC1)};
    for (int row = 0; row < camera_.height; ++row) {
      CameraIntrinsics line = camera_;
      line.height = 1;
      line.cy -= row;
      const double exposed_s = time_s + faults_.readout_s * ((row + 0.5) / camera_.height - 1.0);
      const RenderedView view = render(scene_.surface, line, poseAt(exposed_s));
      view.depth_m.copyTo(whole.depth_m.row(row));
      view.color.copyTo(whole.color.row(row));
      view.cos_incidence.copyTo(whole.cos_incidence.row(row));
    }
    return whole;
  }

  void spoil(cv::Mat& depth_m) const {
    for (int y = 0; y < depth_m.rows; ++y) {
      for (int x = 0; x < depth_m.cols; ++x) {
        float& z = depth_m.at<float>(y, x);
        if (z > 0.0f)
          z = static_cast<float>(
              1.0 / (1.0 / z - faults_.offset_per_m((x + 0.5) / depth_m.cols, (y + 0.5) / depth_m.rows)));
      }
    }
  }

  SimulatedScene scene_;
  CameraIntrinsics camera_;
  SensorFaults faults_;
};

}  // namespace depth_fusion
