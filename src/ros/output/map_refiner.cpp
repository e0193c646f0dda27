#include "ros/output/map_refiner.h"

#include <depth_fusion/LoopStatus.h>
#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "depth_fusion/common/error.h"
#include "depth_fusion/compute/device_image.h"
#include "depth_fusion/pipeline/map_refinement.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

constexpr double kLook_s = 1.0;
constexpr uint32_t kCorrectionQueue = 100;
constexpr double kStill_m = 1e-3;

std::string inMillimetres(double length_m) { return std::to_string(std::lround(1000.0 * length_m)) + " mm"; }

LoopStatus statusOf(const LoopCandidate& loop, double stamp_s, const std::string& frame_id) {
  LoopStatus message;
  message.header = makeHeader(toRosTime(stamp_s), frame_id);
  message.old_keyframe = loop.old_keyframe;
  message.new_keyframe = loop.new_keyframe;
  message.verdict = nameOf(loop.verdict);
  message.text = loop.text();
  message.inliers = loop.inliers;
  message.overlap = loop.overlap;
  message.drift_sigmas = loop.drift_sigmas;
  message.old_to_new = toMessage(loop.T_old_new);
  return message;
}

Keyframes movedBy(const Corrections& corrections, const Keyframes& keyframes) {
  Keyframes moved;
  for (const KeyframePtr& keyframe : keyframes)
    moved.push_back(movedTo(corrections.corrected({keyframe->stamp_s, keyframe->T_W_D}), *keyframe));
  return moved;
}

// The keyframes' numbers from that one on, part by part, those of the last keyframe's part in the end.
std::vector<uint32_t> partByPart(const std::vector<CorrectedKeyframe>& keyframes, size_t first) {
  std::vector<uint32_t> numbers(keyframes.size() - first);
  std::iota(numbers.begin(), numbers.end(), static_cast<uint32_t>(first));
  const auto turn = [&](uint32_t number) {
    const uint32_t part = keyframes[number].part;
    return std::make_pair(part == keyframes.back().part, part);
  };
  std::stable_sort(numbers.begin(), numbers.end(), [&](uint32_t a, uint32_t b) { return turn(a) < turn(b); });
  return numbers;
}

}  // namespace

MapRefiner::MapRefiner(std::shared_ptr<SharedMap> map, FrameMapper& mapper,
                       const MapRefinerParameters& parameters, MapKeeper& keeper, ros::NodeHandle handle,
                       AnnounceMap announce)
    : map_(std::move(map)),
      mapper_(mapper),
      parameters_(parameters),
      keeper_(keeper),
      announce_(std::move(announce)),
      loops_parameters_(mapper.parameters().loops),
      queue_(map_->compute->anotherQueue()),
      publisher_(handle.advertise<LoopStatus>("loops", kCorrectionQueue)) {
  handle.setCallbackQueue(&keeper_.queue());
  server_ = callbacks_.advertiseService<RefineMap::Request, RefineMap::Response>(
      handle, "refine_map", [this](auto& request, auto& response) { return serve(request, response); });
  timer_ = callbacks_.createWallTimer(handle, ros::WallDuration(kLook_s),
                                      [this](const ros::WallTimerEvent&) { look(); });
}

MapRefiner::~MapRefiner() {
  callbacks_.close();
  map_->setLoops(0, {});
}

void MapRefiner::look() {
  follow();
  if (loops_ == nullptr) return;
  publish(loops_->takeCandidates());
  if (!loops_->problem().empty()) note(loops_->problem());
  // Loops are closed one after the other: not before they have come to rest.
  const double move_m = loops_->corrections().largestMove_m();
  const bool rests = std::abs(move_m - std::exchange(seen_move_m_, move_m)) < kStill_m;
  const bool failed = failed_move_m_ && std::abs(move_m - *failed_move_m_) < kStill_m;
  const bool moves = move_m > static_cast<double>(loops_parameters_.least_move_m) || loops_->joinsParts();
  if (!rests || failed || !moves) return;
  try {
    replace();
    failed_move_m_.reset();
    note("");
  } catch (const std::exception& error) {
    failed_move_m_ = move_m;
    note(std::string("the map is not corrected: ") + error.what());
    ROS_ERROR_STREAM(problem_);
  }
}

void MapRefiner::follow() {
  const std::shared_ptr<LoopClosing> before = loops_;  // ends when the map is not locked any more
  map_->locked([this](FusedMap& fused) {
    const uint32_t generation = fused.map().generation();
    if (generation == std::exchange(generation_, generation)) return;
    loops_.reset();
    // A part that was loaded has no keyframes to be made anew from.
    if (parameters_.close_loops && !mapper_.admission().isExternal() && !fused.wasLoaded())
      loops_ = std::make_shared<LoopClosing>(loops_parameters_, LoopsFor::kLiveMap,
                                             fused.map().parameters().color);
    map_->setLoops(generation, {loops_, 0});
    seen_move_m_ = 0.0;
  });
}

void MapRefiner::publish(const std::vector<LoopCandidate>& candidates) {
  if (candidates.empty()) return;
  const Corrections keyframes = loops_->keyframes();
  for (const LoopCandidate& loop : candidates) {
    publisher_.publish(statusOf(loop, keyframes.keyframes().at(loop.new_keyframe).stamp_s, map_->frame_id));
    const bool is_news = loop.verdict == LoopVerdict::kClosed || loop.verdict == LoopVerdict::kUndone;
    if (is_news) ROS_INFO_STREAM(loop.text());
  }
}

bool MapRefiner::serve(RefineMap::Request& request, RefineMap::Response& response) {
  try {
    follow();
    check(loops_ != nullptr,
          "there are no keyframes to make the map from: close_loops is off, poses come from elsewhere, or a "
          "part of the map was loaded");
    check(!request.path.empty() || request.voxel_size_m == 0.0f,
          "the live map keeps its voxels; give a path for a map with others");
    loops_->finish();
    const Corrections corrections =
        request.path.empty() ? replace() : saveTo(keeper_.placeOf(request.path), request.voxel_size_m);
    response.success = true;
    response.keyframes = static_cast<uint32_t>(corrections.keyframes().size());
    response.moved_m = corrections.largestMove_m();
    response.message = "made anew from " + std::to_string(response.keyframes) +
                       " keyframes, which moved by " + inMillimetres(response.moved_m) + " at most";
  } catch (const std::exception& error) {
    response.message = error.what();
  }
  ROS_INFO_STREAM("refine_map: " << response.message);
  return true;
}

PipelineParameters MapRefiner::parametersNow() const {
  return map_->locked([this](FusedMap& fused) {
    PipelineParameters parameters = mapper_.parameters();
    parameters.map = fused.map().parameters();
    return parameters;
  });
}

Corrections MapRefiner::fuse(MapRefinement& refinement) {
  std::vector<CorrectedKeyframe> fused;
  size_t cleared = 0;
  uint32_t part = 0;
  const auto clearUntil = [&](double stamp_s) {
    const auto clearings = map_->locked([](FusedMap& map) { return map.clearings(); });
    for (; cleared < clearings.size() && clearings[cleared].first < stamp_s; ++cleared) {
      const Clearing& clearing = clearings[cleared].second;
      refinement.submaps().clear(clearing.box_W, clearing.isInside);
    }
  };
  while (true) {
    const std::vector<CorrectedKeyframe> known = loops_->keyframes().keyframes();
    if (known.size() == fused.size()) break;
    const size_t fused_before = fused.size();
    fused.insert(fused.end(), known.begin() + static_cast<std::ptrdiff_t>(fused_before), known.end());
    for (const uint32_t number : partByPart(fused, fused_before)) {
      const CorrectedKeyframe& keyframe = fused[number];
      clearUntil(keyframe.stamp_s);
      if (keyframe.part != std::exchange(part, keyframe.part))
        check(refinement.submaps().beginPart(), refinement.submaps().problem());
      refinement.fuse(*loops_->keyframe(number), keyframe.T_W_now);
    }
  }
  clearUntil(std::numeric_limits<double>::infinity());
  check(!refinement.submaps().isEmpty(), "no keyframe shows anything yet; the map stays as it is");
  return Corrections(std::move(fused));
}

void MapRefiner::fuseLastView(MapRefinement& refinement, const Corrections& corrections) {
  const auto [view, last_pose] =
      map_->locked([this](FusedMap&) { return std::make_pair(mapper_.view(), mapper_.lastPose()); });
  if (view == nullptr) return;
  Keyframe last;
  last.view =
      KeyframeView(readImage(view->depth, view->camera), view->camera, loops_parameters_.view_width_px);
  refinement.fuse(last, corrections.corrected(last_pose));
}

Corrections MapRefiner::replace() {
  const std::shared_ptr<Database> scratch = openScratch(mapper_.parameters().submaps.store);
  auto refinement = std::make_unique<MapRefinement>(*queue_, parametersNow());
  const Corrections corrections = fuse(*refinement);
  fuseLastView(*refinement, corrections);
  MapSaver saver(scratch);
  refinement->save(saver, mapper_.camera(), {}, {});
  refinement.reset();  // its memory is needed
  // Its parameters and its pool are the same at all times.
  const SubmapCollection* submaps = map_->locked([](FusedMap& fused) { return &fused.submaps(); });
  ReadMap read(*scratch, *submaps);
  map_->locked([&](FusedMap& fused) {
    const uint32_t before = fused.map().generation();
    check(before == generation_, "the map was emptied or replaced meanwhile");
    const Keyframes keyframes = movedBy(corrections, map_->keyframesOf(before));
    mapper_.replace(fused, read, "the map", corrections);
    generation_ = fused.map().generation();
    map_->keepKeyframes(generation_, keyframes);
    map_->setLoops(generation_, {loops_, loops_->adopt(corrections)});
    keeper_.follow(before, generation_);
    announce_("the map was made anew from " + std::to_string(corrections.keyframes().size()) +
                  " keyframes: loops moved them by up to " + inMillimetres(mapper_.move()->moved_m) +
                  ", and the sensor by " + inMillimetres(mapper_.move()->jump_m),
              fused);
  });
  seen_move_m_ = 0.0;
  return corrections;
}

Corrections MapRefiner::saveTo(const std::string& place, float voxel_size_m) {
  checkPlace(place);
  PipelineParameters parameters = parametersNow();
  if (voxel_size_m > 0.0f) {
    parameters.map.voxel_size_m = voxel_size_m;
    validate(parameters.map.table());
  }
  MapRefinement refinement(*queue_, parameters);
  const Corrections corrections = fuse(refinement);
  MapSaver saver(place);
  const auto [last_pose, keyframes] = map_->locked(
      [this](FusedMap&) { return std::make_pair(mapper_.lastPose(), map_->keyframesOf(generation_)); });
  refinement.save(saver, mapper_.camera(), {last_pose.stamp_s, corrections.corrected(last_pose)},
                  movedBy(corrections, keyframes));
  return corrections;
}

void MapRefiner::note(const std::string& problem) {
  const std::lock_guard<std::mutex> lock(status_mutex_);
  problem_ = problem;
}

void MapRefiner::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::lock_guard<std::mutex> lock(status_mutex_);
  if (!problem_.empty()) status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, problem_);
}

}  // namespace depth_fusion
