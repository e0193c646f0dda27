#include "depth_fusion/pipeline/drift_parameters.h"

namespace depth_fusion {

ParameterTable DriftParameters::table() {
  return {number("frame_m", &frame_m, 0.0, 1.0,
                 "standard deviation of each pose's position beside noise: distortion of depth, stamps"),
          number("frame_rad", &frame_rad, 0.0, 1.0, "the same of its orientation"),
          number("m_after_1m", &m_after_1m, 0.0, 1.0,
                 "standard deviation of the position after a metre of new ground; it grows with the root"),
          number("rad_after_1m", &rad_after_1m, 0.0, 1.0, "the same of the orientation"),
          number("m_after_1rad", &m_after_1rad, 0.0, 1.0,
                 "standard deviation of the position after a turn by a radian to what was not seen before"),
          number("rad_after_1rad", &rad_after_1rad, 0.0, 1.0, "the same of the orientation"),
          number("scale", &scale, 0.0, 1.0,
                 "standard deviation of the factor by which the sensor measures too long: of the distance "
                 "from the start")};
}

}  // namespace depth_fusion
