// The exception of depth_fusion: what failed, where, and what the user can do about it, in one line.
#pragma once

#include <stdexcept>
#include <string>

namespace depth_fusion {

class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Throws Error(message) unless the invariant holds.
inline void check(bool invariant, const std::string& message) {
  if (!invariant) throw Error(message);
}

}  // namespace depth_fusion
