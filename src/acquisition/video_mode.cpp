#include "acquisition/video_mode.h"

#include <regex>

#include "depth_fusion/common/error.h"

namespace depth_fusion {

VideoMode parseVideoMode(const std::string& text, const std::string& parameter) {
  std::smatch parts;
  check(std::regex_match(text, parts, std::regex("(\\d{1,5})x(\\d{1,5})(?:@(\\d{1,4}))?")),
        parameter + " is '" + text + "'; write it as 640x480@30");
  return {std::stoi(parts[1]), std::stoi(parts[2]), parts[3].matched ? std::stoi(parts[3]) : 0};
}

std::string videoModeText(const VideoMode& mode) {
  return std::to_string(mode.width) + "x" + std::to_string(mode.height) +
         (mode.fps > 0 ? "@" + std::to_string(mode.fps) : "");
}

}  // namespace depth_fusion
