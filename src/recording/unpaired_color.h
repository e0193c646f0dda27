// Colour that is there, and belongs to no depth by its stamps.
#pragma once

#include <optional>
#include <string>

namespace depth_fusion {

// One thread uses it.
class UnpairedColor {
 public:
  // A depth image got colour.
  void notePaired();
  // A depth image got none; the stamp of the nearest colour image is later by so much, or there is no colour
  // image. Returns what is wrong, once many in a row got none: with colour at another clock's time, this says
  // so, and with colour at a lower rate it says nothing.
  std::string noteUnpaired(std::optional<double> later_s, double max_gap_s);

 private:
  int in_a_row_ = 0;
  bool was_paired_ = false;
  std::string problem_;
};

}  // namespace depth_fusion
