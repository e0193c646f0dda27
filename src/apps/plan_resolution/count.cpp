#include "apps/plan_resolution/count.h"

#include <cstdio>
#include <iostream>

#include "depth_fusion/common/error.h"
#include "depth_fusion/frames/y_down.h"
#include "depth_fusion/pipeline/motion_model.h"
#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"
#include "depth_fusion/preprocessing/depth_range.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "depth_fusion/registration/registered_recording.h"
#include "depth_fusion/surface_mesh/ply.h"
#include "ros/bags/open_recording.h"
#include "tools/evaluation/block_count.h"

namespace depth_fusion {
namespace {

constexpr double kMaxPoseGap_s = 0.1;

size_t offsetBytes(const PlanRow& row) { return mapBytes(row.map, 0); }

// Returns the end of the rows from `first` on whose offsets fit into the limit together; it is one row at
// least.
size_t endOfPass(const ResolutionPlan& plan, size_t first) {
  size_t bytes = offsetBytes(plan.rows[first]), end = first + 1;
  while (end < plan.rows.size() && bytes + offsetBytes(plan.rows[end]) <= plan.request.limit_bytes)
    bytes += offsetBytes(plan.rows[end++]);
  return end;
}

std::unique_ptr<DepthPreprocessor> preprocessorOf(const RgbdFrame& frame, ComputeContext& compute,
                                                  const PipelineParameters& parameters) {
  return std::make_unique<DepthPreprocessor>(compute, parameters.preprocessing, frame.intrinsics,
                                             parameters.depth_sensor);
}

// Selects blocks for some of the rows, frame by frame.
class SelectionPass {
 public:
  SelectionPass(const CountingOptions& options, ComputeContext& compute, PlanRow* begin, PlanRow* end)
      : options_(options), compute_(compute), begin_(begin), end_(end) {}

  void add(const RgbdFrame& frame, const Pose& T_W_D) {
    if (!preprocessor_) {
      const Eigen::Vector3d centre_W = windowCentre(frame, options_.parameters.depthRange(), T_W_D);
      preprocessor_ = preprocessorOf(frame, compute_, options_.parameters);
      for (PlanRow* row = begin_; row != end_; ++row) {
        selected_.push_back(std::make_unique<SelectedBlocks>(compute_, row->map, centre_W));
      }
    }
    const DepthFrame& depth = preprocessor_->process(frame, motion_.moveTo(frame.stamp_s, T_W_D), timers_);
    for (const auto& selected : selected_) selected->add(depth, T_W_D);
  }

  void finish() {
    check(preprocessor_ != nullptr,
          "no frame of " + namesOf(options_.inputs) + " has a pose; see --trajectory");
    for (size_t i = 0; i < selected_.size(); ++i) setBlocks(begin_[i], selected_[i]->kept());
  }

 private:
  const CountingOptions& options_;
  ComputeContext& compute_;
  PlanRow* begin_;
  PlanRow* end_;
  StageTimers timers_;
  MotionModel motion_;
  std::unique_ptr<DepthPreprocessor> preprocessor_;
  std::vector<std::unique_ptr<SelectedBlocks>> selected_;
};

}  // namespace

struct BlockCounting::Surface {
  virtual ~Surface() = default;
  virtual void count(ResolutionPlan& plan) = 0;
  virtual void tryOut(PlanRow& row) = 0;
};

struct BlockCounting::Mesh : BlockCounting::Surface {
  explicit Mesh(const CountingOptions& options) : mesh(readPly(options.inputs.front())) {
    check(!mesh.triangles.empty(), options.inputs.front() + " has no triangles");
    std::cout << "input: mesh of " << mesh.triangles.size() << " triangles" << std::endl;
  }

  void count(ResolutionPlan& plan) override {
    Eigen::AlignedBox3d box;
    for (const MeshVertex& vertex : mesh.vertices) box.extend(vertex.position_W.cast<double>());
    for (PlanRow& row : plan.rows) {
      if (offsetBytes(row) <= plan.request.limit_bytes)
        setBlocks(row, blocksAround(mesh, row.map, box.center()));
    }
  }

  void tryOut(PlanRow&) override {}

  TriangleMesh mesh;
};

// Holds a recording, which is read as often as needed.
struct BlockCounting::Frames : BlockCounting::Surface {
  explicit Frames(const CountingOptions& counting_options)
      : options(counting_options), compute(options.device), recording(open()) {
    std::cout << "input: " << recording->description() << std::endl;
    std::string remark;
    if (!options.trajectory_file.empty()) trajectory = readPoses(options.trajectory_file, &remark);
    if (!remark.empty()) std::cerr << "plan_resolution: " << remark << std::endl;
  }

  std::unique_ptr<Recording> open() {
    return registered(openRecordings(options.inputs, options.recording), compute,
                      options.parameters.registration);
  }

  void count(ResolutionPlan& plan) override {
    if (trajectory.empty()) track();
    for (size_t first = 0; first < plan.rows.size();) {
      const size_t end = endOfPass(plan, first);
      if (offsetBytes(plan.rows[first]) <= plan.request.limit_bytes) {
        SelectionPass pass(options, compute, plan.rows.data() + first, plan.rows.data() + end);
        forEachPosed("counting, rows " + std::to_string(first + 1) + " to " + std::to_string(end),
                     [&](const RgbdFrame& frame, const Pose& T_W_D) { pass.add(frame, T_W_D); });
        pass.finish();
      }
      first = end;
    }
  }

  void tryOut(PlanRow& row) override {
    PipelineParameters parameters = options.parameters;
    parameters.map = row.map;
    parameters.map.pool_mib = poolMebibytes(row);
    std::unique_ptr<BlockMap> map;
    std::unique_ptr<SubmapCollection> submaps;
    std::unique_ptr<Mapper> mapper;
    MotionModel motion;
    std::unique_ptr<DepthPreprocessor> preprocessor;
    StageTimers timers;
    forEachPosed(
        "trying N " + std::to_string(row.map.blocks_per_axis) + ", M " + std::to_string(row.map.block_size),
        [&](const RgbdFrame& frame, const Pose& T_W_D) {
          if (!map) {
            map = std::make_unique<BlockMap>(compute, parameters.map);
            submaps = std::make_unique<SubmapCollection>(*map, parameters.submaps);
            mapper = std::make_unique<Mapper>(compute, *map, *submaps, parameters, frame.intrinsics);
            preprocessor = preprocessorOf(frame, compute, parameters);
          }
          const DepthFrame& depth = preprocessor->process(frame, motion.moveTo(frame.stamp_s, T_W_D), timers);
          mapper->fuse(frame, depth, T_W_D, true, timers);
        });
    setBlocks(row, submaps->blockCount());
  }

  void track() {
    std::unique_ptr<ReconstructionPipeline> pipeline;
    size_t lost = 0;
    forEach("tracking", [&](const RgbdFrame& frame) {
      if (!pipeline)
        pipeline = std::make_unique<ReconstructionPipeline>(compute, options.parameters, frame.intrinsics);
      const TrackingResult result = pipeline->processFrame(frame).tracking;
      if (result.status == TrackingStatus::kLost) {
        ++lost;
      } else {
        trajectory.push_back({frame.stamp_s, result.T_W_D});
      }
    });
    check(!trajectory.empty() && trajectory.size() >= lost,
          "only " + std::to_string(trajectory.size()) + " of " + std::to_string(trajectory.size() + lost) +
              " frames of " + namesOf(options.inputs) +
              " could be tracked; give its poses with --trajectory");
    if (lost > 0) std::cout << lost << " frames are lost and not counted" << std::endl;
  }

  template <class Visit>
  void forEach(const std::string& what, const Visit& visit) {
    if (!recording) recording = open();
    const size_t all = recording->frameCount();
    const size_t count = options.max_frames == 0 ? all : std::min(all, options.max_frames);
    for (size_t i = 0; i < count; ++i) {
      if (const std::optional<RgbdFrame> frame = nextFrame()) visit(*frame);
      if ((i + 1) % 50 == 0 || i + 1 == count)
        std::cout << what << ": frame " << i + 1 << "/" << count << std::endl;
    }
    recording.reset();
  }

  // Returns nothing for a frame that cannot be read, and says so the first time.
  std::optional<RgbdFrame> nextFrame() {
    try {
      return recording->next();
    } catch (const Error& error) {
      if (!has_complained) std::cerr << "plan_resolution: " << error.what() << "; left out" << std::endl;
      has_complained = true;
      return std::nullopt;
    }
  }

  template <class Visit>
  void forEachPosed(const std::string& what, const Visit& visit) {
    forEach(what, [&](const RgbdFrame& frame) {
      const std::optional<Pose> T_W_D = poseAt(trajectory, frame.stamp_s, kMaxPoseGap_s);
      const bool has_y_up = frame.y_mirrored && !options.trajectory_file.empty();
      if (T_W_D) visit(frame, has_y_up ? mirroredY(*T_W_D) : *T_W_D);
    });
  }

  const CountingOptions& options;
  ComputeContext compute;
  std::unique_ptr<Recording> recording;  // null: read to its end
  Trajectory trajectory;
  bool has_complained = false;
};

BlockCounting::BlockCounting(const CountingOptions& options) {
  if (options.inputs.size() == 1 && endsWith(options.inputs.front(), ".ply")) {
    surface_ = std::make_unique<Mesh>(options);
  } else {
    surface_ = std::make_unique<Frames>(options);
  }
}

BlockCounting::~BlockCounting() = default;

void BlockCounting::count(ResolutionPlan& plan) { surface_->count(plan); }

void BlockCounting::tryOut(PlanRow& row) { surface_->tryOut(row); }

}  // namespace depth_fusion
