#include "recording/unpaired_color.h"

#include <cmath>
#include <sstream>

namespace depth_fusion {
namespace {

constexpr int kMany = 5;        // depth images in a row, where none has had colour so far
constexpr int kVeryMany = 100;  // and where some have

std::string problemText(double later_s, double max_gap_s) {
  std::ostringstream text;
  text << "no colour image is within " << std::lround(1e3 * max_gap_s) << " ms of its depth; the nearest is "
       << std::abs(later_s) << " s " << (later_s > 0.0 ? "later" : "earlier")
       << ": let both be stamped by one clock, with the time when they were taken";
  return text.str();
}

}  // namespace

void UnpairedColor::notePaired() {
  in_a_row_ = 0;
  was_paired_ = true;
  problem_.clear();
}

std::string UnpairedColor::noteUnpaired(std::optional<double> later_s, double max_gap_s) {
  if (!later_s) return problem_;
  if (++in_a_row_ >= (was_paired_ ? kVeryMany : kMany) && problem_.empty())
    problem_ = problemText(*later_s, max_gap_s);
  return problem_;
}

}  // namespace depth_fusion
