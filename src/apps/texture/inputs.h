// What a texture is made of, from a map or from a recording.
#pragma once

#include <string>
#include <vector>

#include "apps/command_line.h"
#include "depth_fusion/texturing/texturing.h"

namespace depth_fusion {

struct TextureArguments {
  std::string map;  // a stored map; or else:
  std::vector<std::string> recording;
  std::string trajectory, mesh;
  std::string output, device;
  RecordingArguments recording_arguments;
  RecordingOptions recording_options;
  std::string color_camera_file;
};

struct TextureInput {
  TriangleMesh mesh;
  std::vector<TexturingView> views;  // in the order of time
};

// Throws Error for a map or a recording without pictures, and for what cannot be read. Frames that cannot be
// read, and those without a pose, are left out.
TextureInput readTextureInput(const TextureArguments& arguments);

}  // namespace depth_fusion
