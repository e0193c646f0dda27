#include "depth_fusion/pipeline/guessed_motion.h"

#include <algorithm>

namespace depth_fusion {
namespace {

constexpr double kWrong_m = 0.05, kWrong_rad = 0.05;
constexpr double kAnywhere_m = 0.5, kAnywhere_rad = 0.5;
// A sensor that seems to stand still may drift so fast, and one of which nothing is known is moved so fast.
constexpr double kDrift_m_s = 0.05, kDrift_rad_s = 0.05;
constexpr double kHand_m_s = 0.3, kHand_rad_s = 0.3;

}  // namespace

void GuessedMotion::measure(double stamp_s, const Vector6d& velocity) {
  last_s_ = stamp_s;
  velocity_ = velocity;
  m_ = rad_ = 0.0;
}

void GuessedMotion::guess(double stamp_s, const Vector6d& velocity) {
  const double seconds = std::max(stamp_s - last_s_, 0.0);
  last_s_ = stamp_s;
  const bool is_known = !velocity_.isZero();
  m_ += seconds *
        std::max({velocity.tail<3>().norm(), velocity_.tail<3>().norm(), is_known ? kDrift_m_s : kHand_m_s});
  rad_ += seconds * std::max({velocity.head<3>().norm(), velocity_.head<3>().norm(),
                              is_known ? kDrift_rad_s : kHand_rad_s});
}

bool GuessedMotion::isTooFar() const { return m_ > kWrong_m || rad_ > kWrong_rad; }

bool GuessedMotion::isAnywhere() const { return m_ > kAnywhere_m || rad_ > kAnywhere_rad; }

}  // namespace depth_fusion
