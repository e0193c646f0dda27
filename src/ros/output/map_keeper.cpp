#include "ros/output/map_keeper.h"

#include <ros/console.h>

#include <filesystem>
#include <utility>

#include "depth_fusion/common/error.h"
#include "ros/output/mesh_export.h"

namespace depth_fusion {
namespace {

using diagnostic_msgs::DiagnosticStatus;

std::string describe(const SaveReport& saved) {
  return "saved to " + saved.place + ": " + std::to_string(saved.blocks) + " blocks, " +
         std::to_string(saved.bytes) + " bytes";
}

std::string describe(const LoadedMap& loaded, const std::string& place, bool read_only) {
  uint64_t blocks = 0;
  for (const SubmapDescription& submap : loaded.description.submaps) blocks += submap.blocks;
  return "loaded from " + place + ": " + std::to_string(blocks) + " blocks and " +
         std::to_string(loaded.keyframes.size()) + " keyframes" +
         (read_only ? ", to find poses in; it stays as it is" : "");
}

}  // namespace

MapKeeper::MapKeeper(std::shared_ptr<SharedMap> map, FrameMapper& mapper,
                     const MapKeeperParameters& parameters, ros::NodeHandle handle, AnnounceMap announce)
    : map_(std::move(map)),
      mapper_(mapper),
      parameters_(parameters),
      announce_(std::move(announce)),
      spinner_(std::make_unique<ros::AsyncSpinner>(1, &queue_)) {
  handle.setCallbackQueue(&queue_);
  save_server_ = callbacks_.advertiseService<SaveMap::Request, SaveMap::Response>(
      handle, "save_map", [this](auto& request, auto& response) { return serveSave(request, response); });
  load_server_ = callbacks_.advertiseService<LoadMap::Request, LoadMap::Response>(
      handle, "load_map", [this](auto& request, auto& response) { return serveLoad(request, response); });
  if (!parameters_.map_file.empty() && parameters_.save_period_s > 0.0f && !parameters_.read_only)
    timer_ = callbacks_.createWallTimer(handle, ros::WallDuration(parameters_.save_period_s),
                                        [this](const ros::WallTimerEvent&) { saveKept(); });
}

MapKeeper::~MapKeeper() {
  callbacks_.close();
  spinner_->stop();
  saveKept();
}

void MapKeeper::loadAtStart() {
  if (!parameters_.map_file.empty()) {
    try {
      loadKept();
    } catch (const std::exception& error) {
      note(std::string("map_file: ") + error.what() + "; nothing is saved there", "");
      ROS_ERROR_STREAM(problem_);
      if (parameters_.read_only) pause();
    }
  }
  spinner_->start();
}

void MapKeeper::loadKept() {
  const std::string place = placeOf("");
  if (const std::unique_ptr<Database> stored = openStoredMap(place)) {
    load(place, *stored, parameters_.read_only);
    return;
  }
  check(!parameters_.read_only, "there is no map to find poses in");
  checkPlace(place);
  note("", "the map will be kept in " + placeName(place));
  kept_generation_ = map_->locked([](FusedMap& fused) { return fused.map().generation(); });
}

void MapKeeper::pause() {
  map_->locked([this](FusedMap& fused) {
    mapper_.admission().setMode(MapMode::kPaused);
    announce_("paused: there is no map to find poses in", fused);
  });
}

void MapKeeper::follow(uint32_t old_generation, uint32_t generation) {
  if (kept_generation_ == old_generation) kept_generation_ = generation;
}

std::string MapKeeper::placeOf(const std::string& path) const {
  const std::string& place = path.empty() ? parameters_.map_file : path;
  check(!place.empty(), "path is empty, and ~map_file says no place either; give the name of a file");
  return isOnServer(place) ? place : absolutePath(place);
}

bool MapKeeper::isKeptAt(const std::string& place) const {
  return !parameters_.map_file.empty() && place == placeOf("");
}

std::optional<SaveReport> MapKeeper::save(const std::string& place, bool only_changes) {
  check(!parameters_.read_only || !isKeptAt(place), "read_only: the map there stays as it is");
  if (saver_ == nullptr || place != place_) {
    saver_ = std::make_unique<MapSaver>(place);
    place_ = place;
  }
  saver_->prepare();
  uint32_t generation = 0;
  map_->locked([&](FusedMap& fused) {
    check(!fused.isEmpty(), "the map is empty; nothing was saved");
    generation = fused.map().generation();
    saver_->capture(fused.submaps(), mapper_.describe(fused), map_->keyframesOf(generation));
  });
  if (only_changes && !saver_->hasChanges()) return std::nullopt;
  const SaveReport saved = saver_->write();
  if (isKeptAt(place)) kept_generation_ = generation;
  return saved;
}

LoadedMap MapKeeper::load(const std::string& place, Database& stored, bool read_only) {
  auto saver = std::make_unique<MapSaver>(place);
  // Its parameters and its pool are the same at all times.
  const SubmapCollection* submaps = map_->locked([](FusedMap& fused) { return &fused.submaps(); });
  ReadMap read(stored, *submaps);
  const LoadedMap& loaded = read.loaded();
  map_->locked([&](FusedMap& fused) {
    mapper_.load(fused, read, stored.name(), {ros::WallTime::now(), ros::Time::now()});
    const uint32_t generation = fused.map().generation();
    map_->keepKeyframes(generation, loaded.keyframes);
    saver->adopt(fused.submaps(), loaded);
    mapper_.admission().setMode(read_only ? MapMode::kLocalisation : MapMode::kMapping);
    if (isKeptAt(place) && !read_only) kept_generation_ = generation;
    const std::string news = describe(loaded, stored.name(), read_only);
    note("", news);
    announce_(news, fused);
  });
  saver_ = std::move(saver);
  place_ = place;
  return loaded;
}

void MapKeeper::saveKept() {
  if (parameters_.map_file.empty() || parameters_.read_only) return;
  try {
    if (!isKept()) return;
    const std::optional<SaveReport> saved = save(placeOf(""), true);
    note("", saved ? describe(*saved) : "");
  } catch (const std::exception& error) {
    note(std::string("the map is not saved: ") + error.what(), "");
    ROS_ERROR_STREAM_THROTTLE(60.0, problem_);
  }
}

bool MapKeeper::isKept() {
  const auto [generation, is_empty] =
      map_->locked([](FusedMap& fused) { return std::make_pair(fused.map().generation(), fused.isEmpty()); });
  if (kept_generation_ != 0 && generation != kept_generation_) {
    kept_generation_ = 0;
    note("the map was emptied or replaced, and " + placeName(placeOf("")) +
             " keeps the one before; save_map with an empty path puts this one in its place",
         "");
    ROS_WARN_STREAM(problem_);
  }
  return kept_generation_ != 0 && !is_empty;
}

bool MapKeeper::serveSave(SaveMap::Request& request, SaveMap::Response& response) {
  try {
    const SaveReport saved = *save(placeOf(request.path), false);
    response.success = true;
    response.message = describe(saved);
    response.bytes = saved.bytes;
    response.submaps = saved.submaps;
    note("", response.message);
  } catch (const std::exception& error) {
    response.message = error.what();
  }
  ROS_INFO_STREAM(response.message);
  return true;
}

bool MapKeeper::serveLoad(LoadMap::Request& request, LoadMap::Response& response) {
  try {
    const std::string place = placeOf(request.path);
    const std::unique_ptr<Database> stored = openDatabase(place, DatabaseAccess::kRead);
    const LoadedMap loaded = load(place, *stored, request.read_only);
    response.success = true;
    response.message = describe(loaded, stored->name(), request.read_only);
    response.bytes = stored->bytes();
    response.submaps = static_cast<uint32_t>(loaded.description.submaps.size());
  } catch (const std::exception& error) {
    response.message = error.what();
    ROS_ERROR_STREAM("load_map: " << error.what());
  }
  return true;
}

void MapKeeper::note(const std::string& problem, const std::string& news) {
  const std::lock_guard<std::mutex> lock(status_mutex_);
  problem_ = problem;
  if (!news.empty()) news_ = news;
}

void MapKeeper::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::lock_guard<std::mutex> lock(status_mutex_);
  if (!problem_.empty()) status.mergeSummary(DiagnosticStatus::WARN, problem_);
  status.add("map file", parameters_.map_file.empty() ? "none" : placeName(parameters_.map_file));
  if (!news_.empty()) status.add("map file's last news", news_);
}

}  // namespace depth_fusion
