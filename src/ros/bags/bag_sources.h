// Where the frames of a bag come from: its topics, its cameras, and tf between them.
#pragma once

#include <string>

#include "depth_fusion/recording/recording.h"
#include "recording/recording_intrinsics.h"
#include "ros/bags/bag_file.h"

namespace depth_fusion {

struct BagSources {
  std::string depth_topic;
  std::string color_topic;  // empty if there is none
  std::string depth_frame;  // on tf
  RecordingIntrinsics intrinsics;
  LensDistortion distortion;
  std::optional<double> depth_unit_m;                // of depth in 16 bits, where the bag says it
  std::optional<CameraIntrinsics> color_intrinsics;  // where they are not those of the depth
  LensDistortion color_distortion;
  std::optional<Pose> T_C_D;  // where the frames of depth and colour differ
  double stamp_lead_s = 0.0;  // by how much depth's stamps are ahead of the receipt
  std::string remark;         // what the user should know about them, or empty
};

// Finds the sources, or takes the given ones. Throws Error naming the bag's topics if depth or intrinsics are
// not there, or if no image of the depth, or of a colour topic that was given, can be read.
BagSources findSources(const BagFiles& bags, const RecordingOptions& options);

}  // namespace depth_fusion
