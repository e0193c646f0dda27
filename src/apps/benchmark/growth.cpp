#include "apps/benchmark/growth.h"

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "apps/benchmark/growth_curve.h"
#include "apps/benchmark/resolution_steps.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

constexpr double kRoomPitch_m = 7.0;  // a room's diagonal is 6; nearer ones come into view
constexpr size_t kYoungFrames = 500;
constexpr double kTarget = 1.1;  // a frame at the end over one after so many

// The parameters of the walk; the pool is large enough for all that it sees.
PipelineParameters walkParameters(double voxel_mm, double window_m) {
  PipelineParameters parameters;
  MapParameters& map = parameters.map;
  map.voxel_size_m = static_cast<float>(0.001 * voxel_mm);
  map.blocks_per_axis =
      static_cast<int>(std::lround(window_m / (static_cast<float>(map.block_size) * map.voxel_size_m)));
  map.pool_mib = 1024;
  return parameters;
}

// Returns the places of the rooms, the first one's among them: a grid of 3 x 3 x 2, so that the window, which
// begins before the first camera, holds them all.
std::vector<Eigen::Vector3d> rooms() {
  std::vector<Eigen::Vector3d> corners;
  for (const int z : {0, 1}) {
    for (const int y : {0, -1, 1}) {
      for (const int x : {0, -1, 1}) corners.push_back(kRoomPitch_m * Eigen::Vector3d(x, y, z));
    }
  }
  return corners;
}

constexpr double kRoomsWindow_m = 20.48, kRoomWindow_m = 10.24;

GrowthSample sampleOf(GrowthWalk& walk, const CameraIntrinsics& camera, double voxel_mm) {
  GrowthSample sample;
  sample.frames = walk.frames();
  sample.lost = walk.lost();
  sample.blocks = walk.blocks();
  sample.blocks_in_view = walk.blocksInView();
  sample.camera = camera;
  sample.voxel_mm = voxel_mm;
  sample.rss_mib = residentSet_mib();
  for (const GrowthStage& stage : growthStages()) {
    sample.stages_ms.push_back(stageMedian_ms(walk.timers(), stage.timer));
  }
  return sample;
}

// Goes forth through new surface, and back, timed, through what is mapped.
GrowthSample visit(GrowthWalk& walk, const Eigen::Vector3d& room_W, const CameraIntrinsics& camera,
                   double voxel_mm) {
  walk.enter(room_W);
  walk.lookForth();
  const double new_surface_ms = stageMedian_ms(walk.timers(), "frame");
  walk.startTiming();
  walk.lookBack();
  GrowthSample sample = sampleOf(walk, camera, voxel_mm);
  sample.new_surface_ms = new_surface_ms;
  std::printf("%s", growthTableRow(sample).c_str());
  std::fflush(stdout);
  return sample;
}

// Afterwards the first room has just been mapped, anew or again.
void enterAndMap(GrowthWalk& walk) {
  walk.enter(rooms().front());
  walk.lookForth();
  walk.startTiming();
}

void printRatios(const StageTimers& young, const StageTimers& grown) {
  double ratio = 0.0;
  for (const GrowthStage& stage : growthStages()) {
    const double young_ms = stageMedian_ms(young, stage.timer);
    const double grown_ms = stageMedian_ms(grown, stage.timer);
    ratio = grown_ms / young_ms;
    std::printf("  %5.3f  %s (%.2f, %.2f ms)\n", ratio, stage.name.c_str(), young_ms, grown_ms);
  }
  std::printf("  target %.1f %s\n", kTarget, ratio <= kTarget ? "met" : "MISSED");
}

// Times, in turn on the same views, the grown walk back in its first room and a new one that knows nothing
// else.
void compareInTurn(ComputeContext& compute, const PipelineParameters& parameters, GrowthWalk& grown,
                   const std::vector<RgbdFrame>& views) {
  GrowthWalk young(compute, parameters, views);
  do enterAndMap(young);
  while (young.frames() < kYoungFrames);
  enterAndMap(grown);
  const size_t young_frames = young.frames(), grown_frames = grown.frames();
  for (size_t view = views.size(); view-- > 0;) {
    GrowthWalk* const first = view % 2 == 0 ? &young : &grown;
    first->look(view);
    (first == &young ? grown : young).look(view);
  }
  std::printf(
      "the same views in turn after %zu and %zu frames, with %zu and %zu blocks, %.0f and %.0f of them in "
      "view:\n",
      young_frames, grown_frames, young.blocks(), grown.blocks(), young.blocksInView(), grown.blocksInView());
  printRatios(young.timers(), grown.timers());
}

void walkThroughRooms(ComputeContext& compute, const GrowthOptions& options) {
  const double voxel_mm = 5.0;
  const std::vector<RgbdFrame> views = roomViews(640, options.views);
  const PipelineParameters parameters = walkParameters(voxel_mm, kRoomsWindow_m);
  GrowthWalk walk(compute, parameters, views);
  GrowthCurve curve{"growth_frames", "a walk through rooms alike, 640x480, 5 mm voxels", "frames mapped",
                    [](const GrowthSample& sample) { return static_cast<double>(sample.frames); }};
  const std::vector<Eigen::Vector3d> corners = rooms();
  while (walk.frames() < options.frames) {
    const Eigen::Vector3d& room_W = corners[curve.samples.size() % options.rooms];
    curve.samples.push_back(visit(walk, room_W, views.front().intrinsics, voxel_mm));
  }
  report(curve, options.output);
  if (options.rooms > 1) {
    curve.name = "growth_blocks";
    curve.x_label = "blocks allocated";
    curve.x = [](const GrowthSample& sample) { return static_cast<double>(sample.blocks); };
    report(curve, options.output);
  }
  compareInTurn(compute, parameters, walk, views);
}

GrowthSample oneRoom(ComputeContext& compute, const std::vector<RgbdFrame>& views, double voxel_mm) {
  GrowthWalk walk(compute, walkParameters(voxel_mm, kRoomWindow_m), views);
  return visit(walk, Eigen::Vector3d::Zero(), views.front().intrinsics, voxel_mm);
}

void overImageSize(ComputeContext& compute, const GrowthOptions& options) {
  GrowthCurve curve{
      "growth_image_size", "image sizes of one camera, 5 mm voxels", "pixels",
      [](const GrowthSample& sample) { return 1.0 * sample.camera.width * sample.camera.height; }};
  for (const int width : options.widths) {
    curve.samples.push_back(oneRoom(compute, roomViews(width, options.few_views), 5.0));
  }
  report(curve, options.output);
}

void overVoxelSize(ComputeContext& compute, const GrowthOptions& options) {
  const std::vector<RgbdFrame> views = roomViews(640, options.few_views);
  GrowthCurve curve{"growth_voxel_size", "voxel sizes, 640x480", "blocks in view",
                    [](const GrowthSample& sample) { return sample.blocks_in_view; }, true};
  for (const double voxel_mm : options.voxels_mm) curve.samples.push_back(oneRoom(compute, views, voxel_mm));
  report(curve, options.output);
}

void measureGrowth(const GrowthOptions& options) {
  std::filesystem::create_directories(options.output);
  ComputeContext compute(options.device);
  std::printf("%s", growthTableHead().c_str());
  walkThroughRooms(compute, options);  // first, for the resident set
  overImageSize(compute, options);
  overVoxelSize(compute, options);
}

}  // namespace

void addGrowthBenchmark(CLI::App& app, GrowthOptions& options) {
  CLI::App* command = app.add_subcommand(
      "growth", "frame time against frames mapped, blocks allocated, image size and voxel size");
  command->add_option("-o,--output", options.output, "folder for tables (.csv) and plots (.png)")
      ->capture_default_str();
  command->add_option("--device", options.device, "OpenCL device, as of reconstruct");
  command->add_option("--frames", options.frames, "frames of the walk through rooms")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("--views", options.views, "views of a room, walked forth and back")
      ->check(CLI::Range(2, 2000))
      ->capture_default_str();
  command
      ->add_option("--rooms", options.rooms,
                   "rooms to walk through again and again; with one, the map stops growing")
      ->check(CLI::Range(size_t{1}, rooms().size()))
      ->capture_default_str();
  command->add_option("--widths", options.widths, "image widths")
      ->check(CLI::Range(160, 4096))
      ->capture_default_str();
  command->add_option("--voxel-sizes", options.voxels_mm, "in mm")
      ->check(CLI::Range(2.0, 100.0))
      ->capture_default_str();
  command->callback([&options] { measureGrowth(options); });
}

}  // namespace depth_fusion
