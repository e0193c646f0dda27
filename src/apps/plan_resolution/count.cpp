#include "apps/plan_resolution/count.h"

#include <cstdio>
#include <iostream>

#include "depth_fusion/common/error.h"
#include "depth_fusion/evaluation/block_count.h"
#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "depth_fusion/surface_mesh/ply.h"
#include "pipeline/depth_in_range.h"
#include "ros/recording.h"

namespace depth_fusion {
namespace {

constexpr double kMaxPoseGap_s = 0.1;

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

size_t offsetBytes(const PlanRow& row) { return mapBytes(row.map, 0); }

// The recording's frames, one after the other, as often as needed.
class Frames {
 public:
  explicit Frames(const CountingOptions& options)
      : options_(options), recording_(openRecording(options.input, options.recording)) {}

  std::string description() const { return recording_->description(); }

  template <class Visit>
  void forEach(const std::string& what, const Visit& visit) {
    if (!recording_) recording_ = openRecording(options_.input, options_.recording);
    const size_t all = recording_->frameCount();
    const size_t count = options_.max_frames == 0 ? all : std::min(all, options_.max_frames);
    for (size_t i = 0; i < count; ++i) {
      const std::optional<RgbdFrame> frame = recording_->next();
      if (!frame) break;
      visit(*frame);
      if ((i + 1) % 50 == 0 || i + 1 == count)
        std::cout << what << ": frame " << i + 1 << "/" << count << std::endl;
    }
    recording_.reset();
  }

 private:
  const CountingOptions& options_;
  std::unique_ptr<Recording> recording_;
};

Trajectory track(const CountingOptions& options, ComputeContext& compute, Frames& frames) {
  std::unique_ptr<ReconstructionPipeline> pipeline;
  Trajectory trajectory;
  size_t lost = 0;
  frames.forEach("tracking", [&](const RgbdFrame& frame) {
    if (!pipeline)
      pipeline = std::make_unique<ReconstructionPipeline>(compute, options.parameters, frame.intrinsics);
    const TrackingResult result = pipeline->processFrame(frame).tracking;
    if (result.status == TrackingStatus::kLost) {
      ++lost;
    } else {
      trajectory.push_back({frame.stamp_s, result.T_W_D});
    }
  });
  check(!trajectory.empty(),
        "no frame of " + options.input + " could be tracked; give its poses with --trajectory");
  if (lost > 0) std::cout << lost << " frames are lost and not counted" << std::endl;
  return trajectory;
}

// The rows [first, the result) whose offsets fit into the limit together, one at least.
size_t endOfPass(const ResolutionPlan& plan, size_t first) {
  size_t bytes = offsetBytes(plan.rows[first]), end = first + 1;
  while (end < plan.rows.size() && bytes + offsetBytes(plan.rows[end]) <= plan.request.limit_bytes)
    bytes += offsetBytes(plan.rows[end++]);
  return end;
}

// Block selection for some of the rows, frame by frame.
class SelectionPass {
 public:
  SelectionPass(const CountingOptions& options, ComputeContext& compute, PlanRow* begin, PlanRow* end)
      : options_(options), compute_(compute), begin_(begin), end_(end) {}

  void add(const RgbdFrame& frame, const Pose& T_W_D) {
    if (!tracker_) {
      const Eigen::Vector3d centre_W = windowCentre(frame, options_.parameters.preprocessing, T_W_D);
      tracker_ = std::make_unique<FrameTracker>(compute_, options_.parameters, frame.intrinsics, nullptr);
      for (PlanRow* row = begin_; row != end_; ++row) {
        selected_.push_back(std::make_unique<SelectedBlocks>(compute_, row->map, centre_W));
      }
    }
    tracker_->follow(frame, T_W_D, timers_);
    for (const auto& selected : selected_) selected->add(*tracker_->depth(), T_W_D);
  }

  void finish() {
    check(tracker_ != nullptr, "no frame of " + options_.input + " has a pose; see --trajectory");
    for (size_t i = 0; i < selected_.size(); ++i) setBlocks(begin_[i], selected_[i]->kept());
  }

 private:
  const CountingOptions& options_;
  ComputeContext& compute_;
  PlanRow* begin_;
  PlanRow* end_;
  StageTimers timers_;
  std::unique_ptr<FrameTracker> tracker_;
  std::vector<std::unique_ptr<SelectedBlocks>> selected_;
};

void countRecording(const CountingOptions& options, ResolutionPlan& plan) {
  ComputeContext compute(options.device);
  Frames frames(options);
  std::cout << "input: " << frames.description() << std::endl;
  const Trajectory trajectory =
      options.trajectory_file.empty() ? track(options, compute, frames) : readPoses(options.trajectory_file);
  for (size_t first = 0; first < plan.rows.size();) {
    const size_t end = endOfPass(plan, first);
    if (offsetBytes(plan.rows[first]) <= plan.request.limit_bytes) {
      SelectionPass pass(options, compute, plan.rows.data() + first, plan.rows.data() + end);
      frames.forEach("counting, rows " + std::to_string(first + 1) + " to " + std::to_string(end),
                     [&](const RgbdFrame& frame) {
                       const std::optional<Pose> T_W_D = poseAt(trajectory, frame.stamp_s, kMaxPoseGap_s);
                       if (T_W_D) pass.add(frame, *T_W_D);
                     });
      pass.finish();
    }
    first = end;
  }
}

void countMesh(const CountingOptions& options, ResolutionPlan& plan) {
  const TriangleMesh mesh = readPly(options.input);
  check(!mesh.triangles.empty(), options.input + " has no triangles");
  Eigen::AlignedBox3d box;
  for (const MeshVertex& vertex : mesh.vertices) box.extend(vertex.position_W.cast<double>());
  std::cout << "input: mesh of " << mesh.triangles.size() << " triangles" << std::endl;
  for (PlanRow& row : plan.rows) {
    if (offsetBytes(row) <= plan.request.limit_bytes)
      setBlocks(row, blocksAround(mesh, row.map, box.center()));
  }
}

}  // namespace

void countBlocks(const CountingOptions& options, ResolutionPlan& plan) {
  endsWith(options.input, ".ply") ? countMesh(options, plan) : countRecording(options, plan);
}

}  // namespace depth_fusion
