// A frame of the past that a new one can be matched to.
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "depth_fusion/frames/frame_features.h"
#include "depth_fusion/frames/rgbd_frame.h"
#include "depth_fusion/relocalisation/keyframe_view.h"

namespace depth_fusion {

// A thumbnail is small enough to be blind to a shift by a tenth of the image.
constexpr int kThumbnailWidth_px = 32;
constexpr int kThumbnailHeight_px = 24;

// A frame's colour image, in few bytes.
struct KeyframeColor {
  std::string jpeg;  // empty: none
  CameraIntrinsics camera;
  Pose T_C_D = Pose::Identity();
};

// It takes some 200 kB.
struct Keyframe {
  FrameFeatures features;  // without the smoothed images
  cv::Mat thumbnail;       // CV_32FC1, zero mean, unit norm
  Pose T_W_D = Pose::Identity();
  double stamp_s = 0.0;  // of the frame

  KeyframeColor color;  // the frame's, where the map has colour: textures are made of it

  // What loops are closed by; a keyframe of the relocaliser alone has none of it.
  KeyframeView view;   // the map as the depth camera saw it then
  double way_m = 0.0;  // that the sensor had gone
};

// What a frame looks like from afar. It has features.
cv::Mat thumbnailOf(const FrameFeatures& features);

// An image, CV_8UC3 or CV_8UC1, in few bytes.
std::string jpegOf(const cv::Mat& color);
// The frame's colour image; without one that fits its camera, none.
KeyframeColor colorOf(const RgbdFrame& frame);

// The frame without what loops are closed by. It has features.
Keyframe keyframeOf(const FrameFeatures& features, const Pose& T_W_D, double stamp_s);

// A keyframe does not change, so that all who need it share it.
using KeyframePtr = std::shared_ptr<const Keyframe>;
using Keyframes = std::vector<KeyframePtr>;

// The keyframe, at another pose.
KeyframePtr movedTo(const Pose& T_W_D, const Keyframe& keyframe);

}  // namespace depth_fusion
