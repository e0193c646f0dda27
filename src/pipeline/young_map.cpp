#include "depth_fusion/pipeline/young_map.h"

namespace depth_fusion {

void YoungMap::begin() {
  forget();
  frames_ = 1;
}

void YoungMap::grow() {
  if (frames_) ++*frames_;
  misses_ = 0;
}

bool YoungMap::isGivenUp(const RelocalisationParameters& parameters) const {
  const bool is_young = frames_ && *frames_ <= parameters.young_map_frames;
  return is_young && (!why_.empty() || misses_ >= parameters.give_up_after_frames);
}

std::string YoungMap::reason() const {
  if (!why_.empty()) return "a map begins anew, for " + why_;
  return "a map begins anew, for nothing fitted the one before, of " + std::to_string(frames()) +
         " frames, in " + std::to_string(misses_) + " frames";
}

}  // namespace depth_fusion
