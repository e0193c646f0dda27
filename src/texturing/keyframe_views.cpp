#include "depth_fusion/texturing/keyframe_views.h"

namespace depth_fusion {

TexturingView viewOf(const KeyframeColor& color, const Pose& T_W_D) {
  return {color.jpeg, color.camera, T_W_D * color.T_C_D.inverse()};
}

std::vector<TexturingView> viewsOf(const Keyframes& keyframes) {
  std::vector<TexturingView> views;
  for (const KeyframePtr& keyframe : keyframes) {
    if (!keyframe->color.jpeg.empty()) views.push_back(viewOf(keyframe->color, keyframe->T_W_D));
  }
  return views;
}

}  // namespace depth_fusion
