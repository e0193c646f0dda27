#include "ros/output/model_picture_parameters.h"

namespace depth_fusion {

ParameterTable ModelPictureParameters::table() {
  return {choice("picture", &picture, {"shaded", "colored"}, "how model_view/image shows the model view"),
          number("picture_rate_hz", &picture_rate_hz, 0.1, 100.0,
                 "how often model_view/image and model_view/depth are published at most")};
}

}  // namespace depth_fusion
