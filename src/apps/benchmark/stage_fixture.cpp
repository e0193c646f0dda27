#include "apps/benchmark/stage_fixture.h"

#include <cmath>

#include "depth_fusion/common/error.h"
#include "depth_fusion/surface_mesh/surface_mesh.h"
#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {
namespace {

constexpr size_t kFusedFrames = 30;

PipelineParameters fixtureParameters(const TrackingInput& input) {
  PipelineParameters parameters = input.parameters;
  parameters.map.color = true;
  parameters.map.pool_mib = 128;
  return parameters;
}

// Gives the frame the distortion of cfg/cameras/tum_freiburg1.yaml.
RgbdFrame throughLenses(RgbdFrame frame) {
  frame.distortion = frame.color_distortion = {0.2624, -0.9531, -0.0054, 0.0026, 1.1633};
  return frame;
}

RgbdFrame besideColor(RgbdFrame frame) {
  frame.T_C_D = Pose(Eigen::Translation3d(-0.025, 0.0, 0.0));
  return frame;
}

RegistrationParameters depthToColor() {
  RegistrationParameters parameters;
  parameters.depth_to_color = true;
  return parameters;
}

Vector6d handVelocity() {
  Vector6d velocity;
  velocity << 0.2, -0.1, 0.1, 0.3, -0.2, 0.1;
  return velocity;
}

// Drops what it receives.
struct NoMesh final : MeshSink {
  void begin(const MeshSize&) override {}
  void addVertices(const MeshVertex*, const MeshColor*, size_t) override {}
  void addTriangles(const MeshTriangle*, size_t) override {}
  void finish() override {}
};

RgbdFrame nextOf(Recording& recording) {
  std::optional<RgbdFrame> frame = recording.next();
  check(frame.has_value(), "a benchmark's recording has too few frames");
  return std::move(*frame);
}

RgbdFrame frameNumber(const TrackingInput& input, size_t number) {
  const std::unique_ptr<Recording> recording = input.open();
  for (size_t i = 0; i < number; ++i) nextOf(*recording);
  return nextOf(*recording);
}

Pose fuseFirstFrames(ReconstructionPipeline& pipeline, const TrackingInput& input) {
  const std::unique_ptr<Recording> recording = input.open();
  Pose T_W_D = Pose::Identity();
  for (size_t i = 0; i < kFusedFrames; ++i) {
    const TrackingResult tracking = pipeline.processFrame(nextOf(*recording)).tracking;
    check(tracking.status != TrackingStatus::kLost, input.name + " is lost: " + tracking.reason);
    T_W_D = tracking.T_W_D;
  }
  return T_W_D;
}

}  // namespace

StageFixture::StageFixture(ComputeContext& compute, const TrackingInput& input)
    : compute_(compute),
      frame_(frameNumber(input, kFusedFrames - 1)),
      next_frame_(frameNumber(input, kFusedFrames)),
      pipeline_(compute, fixtureParameters(input), frame_.intrinsics),
      T_W_D_(fuseFirstFrames(pipeline_, input)),
      fused_map_(pipeline_.map().snapshot({kTsdfLayer, kColorLayer})),
      parameters_(pipeline_.parameters()),
      bent_frame_(throughLenses(frame_)),
      beside_frame_(besideColor(frame_)),
      rectification_(compute, RegistrationParameters()),
      depth_to_color_(compute, depthToColor()),
      preprocessor_(compute, parameters_.preprocessing, frame_.intrinsics, parameters_.depth_sensor),
      next_preprocessor_(compute, parameters_.preprocessing, frame_.intrinsics, parameters_.depth_sensor),
      odometry_(parameters_.texture_odometry, parameters_.depth_sensor),
      tracker_(compute, parameters_.icp_tracking, frame_.intrinsics),
      icp_kernels_(compute),
      partial_sums_(compute, frame_.intrinsics.height * ICP_SUMS * sizeof(float), "ICP sums"),
      fusion_(compute, pipeline_.map(), parameters_.tsdf_fusion),
      color_fusion_(compute, pipeline_.map(), parameters_.color_fusion),
      renderer_(compute, *fused_map_, frame_.intrinsics),
      tracked_renderer_(compute, *fused_map_, frame_.intrinsics) {
  preprocess();
  next_preprocessor_.process(next_frame_, handVelocity());
  fuseDepth();
  const DepthRange range = parameters_.depthRange();
  tracked_renderer_.render(T_W_D_, range.min_m, range.max_m, timers_);
}

const std::vector<StageFixture::Stage>& StageFixture::stages() {
  static const std::vector<Stage> all = {{"registration", &StageFixture::rectify},
                                         {"registration/depth_to_color", &StageFixture::moveDepth},
                                         {"preprocessing", &StageFixture::preprocess, true},
                                         {"texture_odometry", &StageFixture::matchTexture},
                                         {"icp_tracking", &StageFixture::track},
                                         {"icp_tracking/level0", &StageFixture::accumulateLevel<0>, false, 0},
                                         {"icp_tracking/level1", &StageFixture::accumulateLevel<1>, false, 1},
                                         {"icp_tracking/level2", &StageFixture::accumulateLevel<2>, false, 2},
                                         {"tsdf_fusion", &StageFixture::fuseDepth},
                                         {"color_fusion", &StageFixture::fuseColor},
                                         {"model_view", &StageFixture::renderView},
                                         {"surface_mesh", &StageFixture::extractMesh}};
  return all;
}

void StageFixture::run(const Stage& stage) {
  timers_.clear();
  (this->*stage.run)();
  compute_.finish();
}

void StageFixture::rectify() { rectification_.process(bent_frame_); }

void StageFixture::moveDepth() { depth_to_color_.process(beside_frame_); }

void StageFixture::preprocess() { preprocessor_.process(frame_, handVelocity()); }

// The odometry goes to and fro between two frames.
void StageFixture::matchTexture() { odometry_.process(matched_count_++ % 2 == 0 ? frame_ : next_frame_); }

void StageFixture::track() {
  tracker_.track(*next_preprocessor_.result(), *tracked_renderer_.view(),
                 MotionPrior{T_W_D_, std::nullopt, {}}, timers_);
}

// Sums up the system of one iteration.
template <int level>
void StageFixture::accumulateLevel() {
  const IcpTrackingParameters& icp = parameters_.icp_tracking;
  const MatchGates gates = {icp.fine_distance_m, std::cos(icp.fine_normal_angle_rad), icp.huber_sigmas,
                            level == 0 ? icp.fine_row_step : 1};
  icp_kernels_.accumulateSystem(next_preprocessor_.result()->levels[level], *tracked_renderer_.view(),
                                Pose::Identity(), gates, partial_sums_);
}

void StageFixture::fuseDepth() {
  visible_count_ = fusion_.integrate(*preprocessor_.result(), T_W_D_, timers_).blocks_updated;
}

void StageFixture::fuseColor() {
  color_fusion_.integrate(frame_, *preprocessor_.result(), T_W_D_, fusion_.visibleBlocks(), visible_count_,
                          timers_);
}

void StageFixture::renderView() {
  const DepthRange range = parameters_.depthRange();
  renderer_.render(T_W_D_, range.min_m, range.max_m, timers_);
}

void StageFixture::extractMesh() {
  NoMesh mesh;
  exportSurfaceMesh(compute_, *fused_map_, mesh, parameters_.surface_mesh);
}

}  // namespace depth_fusion
