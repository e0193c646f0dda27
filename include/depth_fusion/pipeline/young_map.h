// Whether a map of few frames is to be given up, for nothing fits it.
#pragma once

#include <optional>
#include <string>

#include "depth_fusion/relocalisation/relocalisation_parameters.h"

namespace depth_fusion {

class YoungMap {
 public:
  // The frame that begins a map is fused.
  void begin();
  // Another frame is fused.
  void grow();
  // A frame that has enough depth fits nothing.
  void miss() { ++misses_; }
  // What it began with is wrong, for this reason.
  void giveUp(const std::string& why) { why_ = why; }
  // The map is another one, begun by somebody else.
  void forget() { *this = {}; }

  // Counts the frames that were fused; 0 if nobody counted them.
  int frames() const { return frames_.value_or(0); }
  bool isGivenUp(const RelocalisationParameters& parameters) const;
  // Why it is given up.
  std::string reason() const;

 private:
  std::optional<int> frames_;  // that were fused; none if nobody counted them
  int misses_ = 0;             // since the last of them
  std::string why_;            // it was given up at once
};

}  // namespace depth_fusion
