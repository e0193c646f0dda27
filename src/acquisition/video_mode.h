// Size and rate of a stream, as the user writes them.
#pragma once

#include <string>

namespace depth_fusion {

struct VideoMode {
  int width = 0;
  int height = 0;
  int fps = 0;  // 0: any
};

// "640x480@30" or "640x480". Throws Error naming the parameter.
VideoMode parseVideoMode(const std::string& text, const std::string& parameter);
std::string videoModeText(const VideoMode& mode);

}  // namespace depth_fusion
