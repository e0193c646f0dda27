// Keyframes say where the sensor may be when tracking has lost it: where it saw what looks alike.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "depth_fusion/frames/frame_features.h"
#include "depth_fusion/relocalisation/relocalisation_parameters.h"

namespace depth_fusion {

// A frame of the past that a new one can be matched to; it takes some 200 kB.
struct Keyframe {
  FrameFeatures features;  // without the smoothed images
  cv::Mat thumbnail;       // CV_32FC1, zero mean, unit norm
  Pose T_W_D = Pose::Identity();
};

class Relocaliser {
 public:
  explicit Relocaliser(const RelocalisationParameters& parameters);

  // The parameters hold for the frames to come; keyframes beyond max_keyframes go at once.
  void setParameters(const RelocalisationParameters& parameters);

  // Keeps the frame as a keyframe if it has features and no keyframe is near. When there are too many, the
  // one that stands closest to another goes.
  void add(const FrameFeatures& features, const Pose& T_W_D);
  void reset() { keyframes_.clear(); }

  // Returns the keyframes whose thumbnails are most like the frame's, best first, and at most max_candidates.
  std::vector<const Keyframe*> candidates(const FrameFeatures& features) const;

  const std::vector<Keyframe>& keyframes() const { return keyframes_; }

 private:
  void dropSurplus();

  RelocalisationParameters parameters_;
  std::vector<Keyframe> keyframes_;
};

}  // namespace depth_fusion
