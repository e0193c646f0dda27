#include "depth_fusion/pipeline/map_watch.h"

#include <algorithm>
#include <cstdio>

namespace depth_fusion {
namespace {

constexpr int kFirstFrames = 30;         // say what is usual, and no more
constexpr double kUsual_frames = 300.0;  // of what is usual
constexpr double kOfLate_frames = 15.0;
constexpr int kManyFrames = 30;  // that speak against the map until it is doubted
constexpr int kManyGuesses = 5;  // a fast hand moves by a centimetre or two in each
constexpr int kFramesToComparison = 15;
constexpr int kManyComparisons = 5;  // that differ, in a row
// Between a pose and where an older view puts it: half of what makes a pose a wrong one.
constexpr double kMoved_m = 0.03, kMoved_rad = 0.035;
constexpr double kMoreContradicted = 0.15;
constexpr double kMisfit = 0.85;

}  // namespace

void MapWatch::Fit::take(const Fit& other, double memory_frames) {
  contradicted += (other.contradicted - contradicted) / memory_frames;
  match_quality += (other.match_quality - match_quality) / memory_frames;
}

void MapWatch::Suspicion::note(double stamp_s, bool speaks_against) {
  if (frames == 0) since_s = stamp_s;
  frames = speaks_against ? frames + 1 : 0;
}

void MapWatch::add(double stamp_s, const TrackingResult& result) {
  if (!doubt_.empty() || !(result.match_quality > 0.0)) return;
  watchGuesses(stamp_s, result);
  watchFit(stamp_s, {1.0 - result.explained / result.match_quality, result.match_quality});
}

void MapWatch::watchGuesses(double stamp_s, const TrackingResult& result) {
  guessed_.note(stamp_s, result.guessed_directions > 0);
  if (guessed_.frames >= kManyGuesses) say(guessed_.since_s, result.reason);
}

void MapWatch::watchFit(double stamp_s, const Fit& fit) {
  ++frames_;
  of_late_.take(fit, std::min<double>(frames_, kOfLate_frames));
  const bool misfits =
      frames_ > kFirstFrames && (of_late_.contradicted > usual_.contradicted + kMoreContradicted ||
                                 of_late_.match_quality < kMisfit * usual_.match_quality);
  if (!misfits) usual_.take(fit, std::min<double>(frames_, kUsual_frames));
  misfit_.note(stamp_s, misfits);
  if (misfit_.frames < kManyFrames) return;
  char what[200];
  std::snprintf(
      what, sizeof(what),
      "%.0f %% of the points that meet it contradict it, where %.0f %% is usual, and the others fit "
      "by %.2f, where %.2f is usual",
      100.0 * of_late_.contradicted, 100.0 * usual_.contradicted, of_late_.match_quality,
      usual_.match_quality);
  say(misfit_.since_s, what);
}

bool MapWatch::wantsComparison() {
  if (!doubt_.empty()) return false;
  ++frames_since_comparison_;
  if (moved_.frames == 0 && frames_since_comparison_ < kFramesToComparison) return false;
  frames_since_comparison_ = 0;
  return true;
}

bool MapWatch::waitsForComparison() { return moved_.frames > 0 && ++undecided_ <= kManyComparisons; }

void MapWatch::compare(double stamp_s, const Pose& T_D_older) {
  undecided_ = 0;
  const double m = T_D_older.translation().norm(), rad = rotationAngle(T_D_older);
  moved_.note(stamp_s, m > kMoved_m || rad > kMoved_rad);
  if (moved_.frames == 0) agreed_s_ = stamp_s;
  if (moved_.frames < kManyComparisons) return;
  char what[200];
  std::snprintf(what, sizeof(what),
                "as it was seen before, it puts the sensor %.0f mm and %.1f degrees from where it does now",
                1e3 * m, rad * 180.0 / 3.14159265358979);
  say(agreed_s_, what);
}

void MapWatch::say(double since_s, const std::string& what) {
  char since[100];
  std::snprintf(since, sizeof(since), "the map may be wrong since %.3f s: ", since_s);
  if (doubt_.empty()) doubt_ = since + what;
}

}  // namespace depth_fusion
