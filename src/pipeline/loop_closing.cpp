#include "depth_fusion/pipeline/loop_closing.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "depth_fusion/common/error.h"
#include "depth_fusion/compute/device_image.h"
#include "submaps/keyframe_rows.h"

namespace depth_fusion {
namespace {

constexpr size_t kMostWaiting = 8;
constexpr int kNiceness = 10;  // of the thread: tracking comes first

std::string rowKey(uint32_t number) { return "keyframe " + std::to_string(number); }

}  // namespace

LoopClosing::LoopClosing(const LoopParameters& parameters)
    : parameters_(parameters), thread_([this] { run(); }) {}

LoopClosing::~LoopClosing() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  has_work_.notify_all();
  thread_.join();
}

void LoopClosing::add(double stamp_s, const FrameFeatures& features, const Pose& T_W_D,
                      const ModelView& view) {
  if (last_W_) way_m_ += (T_W_D.translation() - last_W_->translation()).norm();
  last_W_ = T_W_D;
  if (!features.reason.empty() || !isKeyframe(T_W_D)) return;
  auto keyframe = std::make_shared<Keyframe>(keyframeOf(features, T_W_D, stamp_s));
  keyframe->view = KeyframeView(readImage(view.depth, view.camera), view.camera, parameters_.view_width_px);
  keyframe->way_m = way_m_;
  std::optional<KeyframeMotion> motion;
  if (last_keyframe_W_) motion = KeyframeMotion{last_keyframe_W_->inverse() * T_W_D};
  last_keyframe_W_ = T_W_D;
  std::unique_lock<std::mutex> lock(mutex_);
  is_idle_.wait(lock, [this] { return waiting_.size() < kMostWaiting; });
  if (problem_.empty()) waiting_.push_back({std::move(keyframe), motion});
  has_work_.notify_one();
}

bool LoopClosing::isKeyframe(const Pose& T_W_D) const {
  if (!last_keyframe_W_) return true;
  const Pose motion = last_keyframe_W_->inverse() * T_W_D;
  return motion.translation().norm() >= static_cast<double>(parameters_.keyframe_distance_m) ||
         rotationAngle(motion) >= static_cast<double>(parameters_.keyframe_angle_rad);
}

void LoopClosing::beginAnew() {
  last_W_.reset();
  last_keyframe_W_.reset();
}

void LoopClosing::finish() {
  std::unique_lock<std::mutex> lock(mutex_);
  is_idle_.wait(lock, [this] { return waiting_.empty(); });
}

std::vector<LoopCandidate> LoopClosing::takeCandidates() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(candidates_, {});
}

Corrections LoopClosing::corrections() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return corrections_;
}

std::string LoopClosing::problem() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return problem_;
}

void LoopClosing::run() {
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNiceness);
  LoopCloser closer(parameters_, [this](uint32_t number) { return load(number); });
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    has_work_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
    if (ends_) return;
    const Waiting added = waiting_.front();
    lock.unlock();
    LoopReport report;
    Corrections corrections;
    std::string problem;
    try {
      keep(static_cast<uint32_t>(closer.graph().size()), *added.keyframe);
      report = closer.add(added.keyframe, added.motion);
      if (report.poses_changed) corrections = closer.corrections();
    } catch (const std::exception& error) {
      problem = error.what();
    }
    lock.lock();
    candidates_.insert(candidates_.end(), report.candidates.begin(), report.candidates.end());
    if (report.poses_changed) corrections_ = std::move(corrections);
    waiting_.pop_front();
    if (!problem.empty()) {
      problem_ = "loops are not sought any more: " + problem;
      waiting_.clear();
    }
    is_idle_.notify_all();
  }
}

void LoopClosing::keep(uint32_t number, const Keyframe& keyframe) {
  if (keyframes_ == nullptr) keyframes_ = openScratch("");
  const std::unique_ptr<DatabaseWriter> writer = keyframes_->write();
  writer->put(rowKey(number), keyframeRow(keyframe));
  writer->commit();
}

KeyframePtr LoopClosing::load(uint32_t number) {
  const std::optional<std::string> row = keyframes_->read()->get(rowKey(number));
  check(row.has_value(), "a keyframe is not where it was kept");
  return std::make_shared<const Keyframe>(parseKeyframe(*row, "a keyframe"));
}

}  // namespace depth_fusion
