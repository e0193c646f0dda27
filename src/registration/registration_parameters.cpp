#include "depth_fusion/registration/registration_parameters.h"

namespace depth_fusion {

ParameterTable RegistrationParameters::table() {
  return {
      number("depth_unit_m", &depth_unit_m, 0.0, 1.0,
             "metres a unit of 16-bit depth images; 0: as the driver or the recording says"),
      number("depth_scale", &depth_scale, 0.5, 2.0,
             "factor on all depth, for a sensor that measures too short or too long"),
      flag("depth_to_color", &depth_to_color,
           "true: depth is moved to the colour camera; false: each stays with its own camera, which the "
           "other stages know"),
      number(
          "max_relative_step", &max_relative_step, 0.001, 1.0,
          "depth step between neighbours, as a fraction of the depth, across which nothing is interpolated")};
}

}  // namespace depth_fusion
