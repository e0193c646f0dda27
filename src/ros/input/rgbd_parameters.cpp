#include "ros/input/rgbd_parameters.h"

#include "depth_fusion/masking/solid_body.h"
#include "ros/input/transport_plugin.h"

namespace depth_fusion {
namespace {

constexpr char kAuto[] = "auto";

void checkUnlessAuto(const std::string& image, const std::string& transport,
                     const std::vector<std::string>& own) {
  if (transport != kAuto) checkTransport(image, transport, own);
}

}  // namespace

std::vector<std::string> ownDepthTransports() { return {"raw", "compressedDepth", "compressed", "points"}; }

std::vector<std::string> ownColorTransports() { return {"raw", "compressed"}; }

ParameterTable RgbdParameters::table() {
  return {atStartOnly(text("image_transport", &image_transport,
                           "of both images, where depth_transport and color_transport are auto, too: raw, "
                           "compressed, or one that has a plugin of image_transport here; auto: raw, or a "
                           "compressed one where only that is published")),
          atStartOnly(text("depth_transport", &depth_transport,
                           "of depth/image: as image_transport, or compressedDepth; points: the topic "
                           "is one of clouds, sensor_msgs/PointCloud2")),
          atStartOnly(text("color_transport", &color_transport, "of rgb/image: as image_transport")),
          number("max_pairing_gap_s", &pairing.max_gap_s, 0.0, 1.0,
                 "colour farther from its depth than this is left out"),
          number("max_color_wait_s", &pairing.max_wait_s, 0.0, 10.0,
                 "how long a depth image waits for its colour")};
}

std::string RgbdParameters::depthTransport() const {
  return depth_transport == kAuto ? image_transport : depth_transport;
}

std::string RgbdParameters::colorTransport() const {
  return color_transport == kAuto ? image_transport : color_transport;
}

void RgbdParameters::checkTexts() const {
  checkUnlessAuto("depth/image", depthTransport(), ownDepthTransports());
  checkUnlessAuto("rgb/image", colorTransport(), ownColorTransports());
  parseBody(masking.body);
}

}  // namespace depth_fusion
