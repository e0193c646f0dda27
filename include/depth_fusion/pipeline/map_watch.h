// A watch over the map: whether what is seen contradicts it for long.
#pragma once

#include <string>

#include "depth_fusion/frames/tracking_result.h"

namespace depth_fusion {

class MapWatch {
 public:
  // The frame is fused.
  void add(double stamp_s, const TrackingResult& result);
  // Whether the next frame is to be compared with an older view of the map; says so of some frames only.
  bool wantsComparison();
  // By the older view, the frame is this motion away from its pose; none if the view is taken then.
  void compare(double stamp_s, const Pose& T_D_older);
  // A frame cannot be compared. Whether the next one is to be, for some frames before it have differed: what
  // says nothing decides nothing.
  bool waitsForComparison();
  // Why the map may be wrong, and since when; empty if nothing speaks for it.
  const std::string& doubt() const { return doubt_; }
  // Another map is watched.
  void reset() { *this = {}; }

 private:
  // How a frame fits the map, or frames do in the mean.
  struct Fit {
    double contradicted = 0.0;   // of the points that meet the map, those that do not match it
    double match_quality = 0.0;  // of those that do

    void take(const Fit& other, double memory_frames);
  };
  // Frames in a row that speak against the map.
  struct Suspicion {
    int frames = 0;
    double since_s = 0.0;

    void note(double stamp_s, bool speaks_against);
  };

  void watchGuesses(double stamp_s, const TrackingResult& result);
  void watchFit(double stamp_s, const Fit& fit);
  void say(double since_s, const std::string& what);

  int frames_ = 0;
  Fit usual_, of_late_;
  Suspicion guessed_, misfit_, moved_;
  int frames_since_comparison_ = 0;
  int undecided_ = 0;      // frames in a row that could not be compared
  double agreed_s_ = 0.0;  // when the last comparison did not differ
  std::string doubt_;
};

}  // namespace depth_fusion
