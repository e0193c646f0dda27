#include "tools/simulation/scene_library.h"

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <fstream>

#include "depth_fusion/common/error.h"
#include "tools/simulation/scenes.h"

namespace depth_fusion {
namespace {

const char* const kSceneFile = "scene.yaml";

std::string knownNames() {
  std::string names;
  for (const SceneEntry& entry : sceneLibrary()) names += (names.empty() ? "" : ", ") + entry.name;
  return names;
}

const SceneEntry& entryOf(const std::string& name) {
  for (const SceneEntry& entry : sceneLibrary()) {
    if (entry.name == name) return entry;
  }
  throw Error("there is no scene '" + name + "'; the scenes are " + knownNames());
}

}  // namespace

const std::vector<SceneEntry>& sceneLibrary() {
  static const std::vector<SceneEntry> scenes = {
      {"room", "a textured, furnished room of 4 x 3 x 2.5 m, Kinect-like sensor", makeRoomScene},
      {"large_room", "a textured, furnished room of 8 x 6 m, Kinect-like sensor", makeLargeRoomScene},
      {"object", "a figure of 0.2 m on a table, orbited by a close-range precision sensor", makeObjectScene},
      {"seal",
       "a carved seal of 0.15 m with a flat, printed face of a coin's size, orbited by a precision scanner",
       makeSealScene},
      {"wall", "a textured flat wall without end, passed at 1 m; geometry leaves three directions free",
       makeWallScene},
      {"floor_wall", "a textured floor and one wall, walked along; the walk's direction is free",
       makeFloorWallScene},
      {"cylinder", "a textured round column on a floor, walked around; turning about its axis is free",
       makeCylinderScene},
      {"white_room", "the room in one plain colour, without light and shade: geometry alone",
       makeWhiteRoomScene},
      {"building", "corridors and 24 rooms over 60 x 30 m, two rooms exactly alike, Kinect-like sensor",
       makeBuildingScene},
      {"corridor", "a corridor of 100 m between two lobbies, walked there and back", makeCorridorScene},
      {"white_corridor", "the corridor in one plain colour, without light and shade", makeWhiteCorridorScene},
      {"repeated_corridor", "a corridor of 90 m that is exactly the same every 3 m, walked along for 140 s",
       makeRepeatedCorridorScene},
      {"alike", "a room of 8 x 6 m whose lamps, shelves and tiles are the same again and again",
       makeAlikeScene},
      {"person", "the room, and from 1 to 4 s somebody before the camera, wherever it looks",
       makePersonScene},
      {"hand", "the room, and a hand over the lens from 1 to 1.8 s", makeHandScene},
      {"turntable", "the room from one place, and things that turn on its table", makeTurntableScene},
      {"mirror", "the room with a mirror on a wall", makeMirrorScene},
      {"glass", "the room, a part of it behind glass", makeGlassScene},
      {"backing", "the room from 0.3 m before its wall, moving back", makeBackingScene},
      {"shaken", "the room, shaken at up to 120 deg/s after the first second, with a rolling shutter",
       makeShakenScene},
  };
  return scenes;
}

SimulatedScene sceneWithWalks(std::vector<Primitive> solids, const std::vector<Walk>& walks) {
  SimulatedScene scene{Scene(std::move(solids)), kinectSensor(), walks.front().path};
  scene.walks = walks;
  return scene;
}

SimulatedScene makeScene(const std::string& name) { return entryOf(name).make(); }

void writeSceneName(const std::string& folder, const std::string& name) {
  const std::filesystem::path path = std::filesystem::path(folder) / kSceneFile;
  std::ofstream file(path);
  file << "# The built-in scene that this recording shows, for `evaluate --mesh`\nscene: " << name << "\n";
  check(file.flush().good(),
        "cannot write " + path.string() + "; is the folder writable and the disk not full?");
}

std::string findSceneName(const std::string& folder_or_name) {
  const std::filesystem::path path = std::filesystem::path(folder_or_name) / kSceneFile;
  if (!std::filesystem::exists(path)) {
    const bool is_path = folder_or_name.find('/') != std::string::npos;
    check(!is_path, path.string() +
                        " is missing: the scene must be a folder written by simulate, or one of " +
                        knownNames());
    return entryOf(folder_or_name).name;
  }
  try {
    return entryOf(YAML::LoadFile(path.string())["scene"].as<std::string>()).name;
  } catch (const YAML::Exception& exception) {
    throw Error(path.string() + ": cannot read `scene: NAME` (" + exception.what() + ")");
  }
}

}  // namespace depth_fusion
