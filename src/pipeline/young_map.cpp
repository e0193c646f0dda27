#include "depth_fusion/pipeline/young_map.h"

namespace depth_fusion {

void YoungMap::begin() {
  frames_ = 1;
  misses_ = 0;
}

void YoungMap::grow() {
  if (frames_) ++*frames_;
  misses_ = 0;
}

bool YoungMap::isGivenUp(const RelocalisationParameters& parameters) const {
  return frames_ && *frames_ <= parameters.young_map_frames && misses_ >= parameters.give_up_after_frames;
}

std::string YoungMap::reason() const {
  return "a map begins anew, for nothing fitted the one before, of " + std::to_string(frames_.value_or(0)) +
         " frames, in " + std::to_string(misses_) + " frames";
}

}  // namespace depth_fusion
