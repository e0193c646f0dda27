// The built-in scenes by name. A new one is a function that returns a SimulatedScene, and a row in
// scene_library.cpp.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/simulation/camera_path.h"
#include "tools/simulation/scene.h"
#include "tools/simulation/sensor_model.h"
#include "tools/simulation/walk.h"

namespace depth_fusion {

struct SimulatedScene {
  Scene surface;
  SensorModel sensor;
  GazePath path;
  bool looks_around = false;  // the camera turns on its own account, not only as it walks
  // Returns solids that are seen, too, but are no part of the surface: what moves, mirrors, glass.
  std::function<std::vector<Primitive>(const Pose& T_W_D, double time_s)> also_seen = {};
  std::vector<Walk> walks = {};  // where there are several paths; the first of them is `path`
};

struct SceneEntry {
  std::string name;
  std::string help;
  SimulatedScene (*make)();
};

const std::vector<SceneEntry>& sceneLibrary();

// Throws Error listing the known names if there is no such scene.
SimulatedScene makeScene(const std::string& name);

// A simulated recording's folder says which scene it shows.
void writeSceneName(const std::string& folder, const std::string& name);
// Returns the scene's name, from a folder written by `simulate` or given as it is. Throws Error as
// makeScene() does.
std::string findSceneName(const std::string& folder_or_name);

}  // namespace depth_fusion
