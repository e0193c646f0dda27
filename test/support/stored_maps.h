// Maps to be stored, and how they are stored.
#pragma once

#include <memory>
#include <string>

#include "depth_fusion/submaps/map_file.h"
#include "support/changing_map.h"

namespace depth_fusion {

inline SignedDistance sphere(const Eigen::Vector3d& centre, double radius) {
  return [=](const Eigen::Vector3d& p) { return (p - centre).norm() - radius; };
}

// Its voxels are 1 cm.
inline MapParameters smallMap() {
  MapParameters parameters;
  parameters.voxel_size_m = 0.01f;
  parameters.blocks_per_axis = 32;
  parameters.pool_mib = 4;
  return parameters;
}

inline MapDescription describing(BlockMap& map) {
  MapDescription description;
  MapParameters parameters = map.parameters();
  for (const Parameter& row : withPrefix("map", parameters.table()))
    description.parameters.emplace_back(row.name, valueText(row));
  description.parameters.emplace_back("tsdf_fusion/rule", "kalman");
  description.camera = {640, 480, 525.0, 525.0, 319.5, 239.5};
  description.last_pose.T_W_D.translation() << 1.0, 2.0, 3.0;
  return description;
}

inline KeyframePtr someKeyframe(double x) {
  Keyframe keyframe;
  keyframe.T_W_D.translation().x() = x;
  keyframe.thumbnail = cv::Mat::zeros(kThumbnailHeight_px, kThumbnailWidth_px, CV_32FC1);
  keyframe.features.camera = {640, 480, 525.0, 525.0, 319.5, 239.5};
  return std::make_shared<const Keyframe>(keyframe);
}

// The functions below are for maps that are in the pool as a whole.
inline void capture(MapSaver& saver, BlockMap& map, const Keyframes& keyframes = {}) {
  SubmapCollection submaps(map, {});
  saver.prepare();
  saver.capture(submaps, describing(map), keyframes);
}

inline SaveReport save(MapSaver& saver, BlockMap& map, const Keyframes& keyframes = {}) {
  capture(saver, map, keyframes);
  return saver.write();
}

inline void adopt(MapSaver& saver, BlockMap& map, const LoadedMap& loaded) {
  SubmapCollection submaps(map, {});
  saver.adopt(submaps, loaded);
}

// Fills the map with the stored one. Throws Error as ReadMap does: the map is then as it was.
inline LoadedMap loadMap(Database& database, BlockMap& map) {
  SubmapCollection submaps(map, {});
  ReadMap read(database, submaps);
  read.moveTo(submaps);
  return read.loaded();
}

inline LoadedMap load(const std::string& location, BlockMap& map) {
  return loadMap(*openDatabase(location, DatabaseAccess::kRead), map);
}

}  // namespace depth_fusion
