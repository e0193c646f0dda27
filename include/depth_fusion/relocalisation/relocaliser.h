// Keyframes say where the sensor may be when tracking has lost it: where it saw what looks alike.
#pragma once

#include "depth_fusion/relocalisation/keyframe.h"
#include "depth_fusion/relocalisation/relocalisation_parameters.h"

namespace depth_fusion {

class Relocaliser {
 public:
  explicit Relocaliser(const RelocalisationParameters& parameters);

  // The parameters hold for the frames to come; keyframes beyond max_keyframes go at once.
  void setParameters(const RelocalisationParameters& parameters);

  // Keeps the frame as a keyframe if it has features and no keyframe is near. When there are too many, the
  // one that stands closest to another goes. With `pictured`, the frame itself, it has its colour image, too.
  void add(double stamp_s, const FrameFeatures& features, const Pose& T_W_D,
           const RgbdFrame* pictured = nullptr);
  // Forgets the keyframes that there are for those of another map, all of which are kept until one comes.
  void reset(Keyframes keyframes = {});

  // Returns the keyframes whose thumbnails are most like the frame's, best first, and at most max_candidates.
  Keyframes candidates(const FrameFeatures& features) const;

  const Keyframes& keyframes() const { return keyframes_; }

 private:
  void dropSurplus();

  RelocalisationParameters parameters_;
  Keyframes keyframes_;
};

}  // namespace depth_fusion
