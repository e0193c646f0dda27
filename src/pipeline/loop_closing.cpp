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

// Makes a keyframe that loops are not sought by.
Keyframe viewOnly(const CameraIntrinsics& camera, const Pose& T_W_D, double stamp_s) {
  Keyframe keyframe;
  keyframe.features.camera = camera;
  keyframe.features.reason = "only its view is kept";
  keyframe.thumbnail = cv::Mat::zeros(kThumbnailHeight_px, kThumbnailWidth_px, CV_32FC1);
  keyframe.T_W_D = T_W_D;
  keyframe.stamp_s = stamp_s;
  return keyframe;
}

}  // namespace

LoopClosing::LoopClosing(const LoopParameters& parameters, LoopsFor use, bool keeps_color)
    : parameters_(parameters), use_(use), keeps_color_(keeps_color), thread_([this] { run(); }) {}

LoopClosing::~LoopClosing() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  has_work_.notify_all();
  thread_.join();
}

void LoopClosing::add(const RgbdFrame& frame, const FrameFeatures& features, const Pose& T_W_D,
                      const ModelView& view, uint32_t world) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (!isOf(world)) return;
  if (last_W_) way_m_ += (T_W_D.translation() - last_W_->translation()).norm();
  last_W_ = T_W_D;
  const Role role = roleOf(features, T_W_D);
  if (!problem_.empty() || role == Role::kNone) return;
  const auto has_room = [this] { return waiting_.size() < kMostWaiting; };
  if (use_ == LoopsFor::kLiveMap && !has_room()) return;
  const double way_m = way_m_;
  lock.unlock();
  Waiting added;
  added.keyframe =
      std::make_shared<Keyframe>(role == Role::kKeyframe ? keyframeOf(features, T_W_D, frame.stamp_s)
                                                         : viewOnly(view.camera, T_W_D, frame.stamp_s));
  added.keyframe->view =
      KeyframeView(readImage(view.depth, view.camera), view.camera, parameters_.view_width_px);
  added.keyframe->way_m = way_m;
  if (keeps_color_ && colorProblem(frame).empty()) {
    added.color = frame.color.clone();
    added.keyframe->color = {"", colorCamera(frame), frame.T_C_D.value_or(Pose::Identity())};
  }
  lock.lock();
  is_idle_.wait(lock, has_room);
  if (!isOf(world)) return;
  if (last_view_W_) added.motion = KeyframeMotion{last_view_W_->inverse() * T_W_D};
  added.T_W_then = T_W_D;
  last_view_W_ = T_W_D;
  if (role == Role::kKeyframe) last_keyframe_W_ = T_W_D;
  waiting_.push_back(std::move(added));
  has_work_.notify_one();
}

LoopClosing::Role LoopClosing::roleOf(const FrameFeatures& features, const Pose& T_W_D) const {
  const auto isApart = [&](const std::optional<Pose>& last_W, float distance_m, float angle_rad) {
    if (!last_W) return true;
    const Pose motion = last_W->inverse() * T_W_D;
    return motion.translation().norm() >= static_cast<double>(distance_m) ||
           rotationAngle(motion) >= static_cast<double>(angle_rad);
  };
  if (features.reason.empty() &&
      isApart(last_keyframe_W_, parameters_.keyframe_distance_m, parameters_.keyframe_angle_rad))
    return Role::kKeyframe;
  const bool is_view = use_ == LoopsFor::kLiveMap &&
                       isApart(last_view_W_, parameters_.view_distance_m, parameters_.view_angle_rad);
  return is_view ? Role::kView : Role::kNone;
}

void LoopClosing::beginAnew() {
  const std::lock_guard<std::mutex> lock(mutex_);
  last_W_.reset();
  last_keyframe_W_.reset();
  last_view_W_.reset();
}

uint32_t LoopClosing::adopt(const Corrections& applied) {
  const std::vector<CorrectedKeyframe>& moved = applied.keyframes();
  const std::lock_guard<std::mutex> lock(mutex_);
  if (moved.empty()) return world_;
  const Pose T_new_old = orthonormalized(moved.back().T_W_now * moved.back().T_W_then.inverse());
  joins_parts_ = false;
  for (size_t i = 0; i < known_.size(); ++i) {
    known_[i].T_W_then = i < moved.size() ? moved[i].T_W_now : T_new_old * known_[i].T_W_then;
    joins_parts_ = joins_parts_ || (i < moved.size() && moved[i].part != known_[i].part);
  }
  for (Waiting& waiting : waiting_) waiting.T_W_then = T_new_old * waiting.T_W_then;
  for (std::optional<Pose>* last_W : {&last_W_, &last_keyframe_W_, &last_view_W_}) {
    if (*last_W) *last_W = T_new_old * **last_W;
  }
  constexpr double kNoMove_m = 1e-6;
  is_moved_ = Corrections(known_).largestMove_m() > kNoMove_m;  // by what came while these were applied
  return ++world_;
}

void LoopClosing::finish() {
  std::unique_lock<std::mutex> lock(mutex_);
  const size_t there = known_.size() + waiting_.size();
  is_idle_.wait(lock, [&] { return waiting_.empty() || known_.size() >= there; });
}

std::vector<LoopCandidate> LoopClosing::takeCandidates() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(candidates_, {});
}

Corrections LoopClosing::keyframes() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return Corrections(known_);
}

Corrections LoopClosing::corrections() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return is_moved_ ? Corrections(known_) : Corrections();
}

bool LoopClosing::joinsParts() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return joins_parts_;
}

std::string LoopClosing::problem() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return problem_;
}

void LoopClosing::run() {
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNiceness);
  LoopCloser closer(parameters_, [this](uint32_t number) { return keyframe(number); });
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    has_work_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
    if (ends_) return;
    Waiting added = waiting_.front();
    lock.unlock();
    LoopReport report;
    std::string problem;
    try {
      compare(closer, added, report);
    } catch (const std::exception& error) {
      problem = error.what();
    }
    lock.lock();
    if (problem.empty()) {
      note(closer, report);
      waiting_.pop_front();
    } else {
      problem_ = "loops are not sought any more: " + problem;
      waiting_.clear();
    }
    is_idle_.notify_all();
  }
}

void LoopClosing::compare(LoopCloser& closer, Waiting& added, LoopReport& report) {
  if (!added.color.empty()) added.keyframe->color.jpeg = jpegOf(added.color);
  keep(static_cast<uint32_t>(closer.graph().size()), *added.keyframe);
  report = closer.add(added.keyframe, added.motion);
}

void LoopClosing::note(const LoopCloser& closer, const LoopReport& report) {
  candidates_.insert(candidates_.end(), report.candidates.begin(), report.candidates.end());
  const Waiting& added = waiting_.front();
  CorrectedKeyframe known{added.keyframe->stamp_s, added.T_W_then, closer.pose(report.number), report.number,
                          report.number};
  if (added.motion) {
    known.stretch = known_.back().stretch;
    known.part = known_.back().part;
  }
  known_.push_back(known);
  if (!report.poses_changed) return;
  const std::vector<CorrectedKeyframe> now = closer.corrections().keyframes();
  for (size_t i = 0; i < known_.size(); ++i) {
    known_[i].T_W_now = now[i].T_W_now;
    joins_parts_ = joins_parts_ || now[i].part != known_[i].part;
    known_[i].part = now[i].part;
  }
  is_moved_ = true;
}

void LoopClosing::keep(uint32_t number, const Keyframe& keyframe) {
  const std::lock_guard<std::mutex> lock(store_mutex_);
  if (keyframes_ == nullptr) keyframes_ = openScratch("");
  const std::unique_ptr<DatabaseWriter> writer = keyframes_->write();
  writer->put(rowKey(number), keyframeRow(keyframe));
  writer->commit();
}

KeyframePtr LoopClosing::keyframe(uint32_t number) {
  const std::lock_guard<std::mutex> lock(store_mutex_);
  const std::optional<std::string> row =
      keyframes_ == nullptr ? std::nullopt : keyframes_->read()->get(rowKey(number));
  check(row.has_value(), "a keyframe is not where it was kept");
  return std::make_shared<const Keyframe>(parseKeyframe(*row, "a keyframe"));
}

}  // namespace depth_fusion
