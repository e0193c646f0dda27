#include "apps/benchmark/long_walk.h"

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "common/io/image_file.h"
#include "common/io/text_file.h"
#include "depth_fusion/common/percentile.h"
#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "depth_fusion/submaps/world_mesh.h"
#include "depth_fusion/surface_mesh/ply.h"
#include "tools/plots/line_plot.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

constexpr char kWalkTableHead[] =
    "frames,way [m],submaps,blocks,blocks in the pool,in memory [MiB],in the store [MiB],RSS [MiB],"
    "frame median [ms],frame p99 [ms],points left out\n";

// In bytes; 0 where the system does not say.
size_t residentBytes() {
  size_t pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return resident * static_cast<size_t>(sysconf(_SC_PAGESIZE));
}

double mebibytes(size_t bytes) { return static_cast<double>(bytes) / (1 << 20); }

class LongWalk {
 public:
  explicit LongWalk(const LongWalkOptions& options) : options_(options), compute_(options.device) {
    SimulationOptions simulation;
    simulation.scene = options.scene;
    simulation.walk = options.walk;
    simulation.frames = options.frames;
    simulation.fps = options.fps;
    simulation.intrinsics = makeScene(options.scene).sensor.camera;
    while (simulation.intrinsics.width > options.width) simulation.intrinsics = halved(simulation.intrinsics);
    recording_ = std::make_unique<SimulatedRecording>(simulation);
    std::filesystem::create_directories(options.output);
  }

  void run() {
    std::string table = kWalkTableHead;
    const int rows = std::min(options_.frames, 100);
    for (int frame = 0; frame < options_.frames; ++frame) {
      step();
      if ((frame + 1) * rows / options_.frames == frame * rows / options_.frames) continue;
      table += row();
      std::printf("%s", row().c_str());
      std::fflush(stdout);
      notePoints();
    }
    writeText(options_.output + "/long_walk.csv", table);
    LinePlot plot{"Memory on the way", "way [m]", "MiB", {resident_, pool_, store_}};
    writePicture(options_.output + "/long_walk.png", draw(plot));
    sayStore();
    if (!options_.no_mesh) exportMesh();
  }

 private:
  void step() {
    const RgbdFrame frame = *recording_->next();
    if (pipeline_ == nullptr)
      pipeline_ = std::make_unique<ReconstructionPipeline>(compute_, options_.parameters, frame.intrinsics);
    if (frames_++ > 0) way_m_ += (frame.T_W_D->translation() - last_W_).norm();
    last_W_ = frame.T_W_D->translation();
    const FrameResult result = pipeline_->processFrame(frame, *frame.T_W_D);
    left_out_ +=
        result.fusion.points_outside + result.fusion.blocks_requested - result.fusion.blocks_allocated;
  }

  std::string row() {
    SubmapCollection& submaps = pipeline_->submaps();
    const StoreUsage store = submaps.usage();
    const std::vector<double>& times_ms = pipeline_->timers().samplesMs().at("frame");
    char text[300];
    std::snprintf(text, sizeof(text), "%zu,%.1f,%zu,%zu,%zu,%.1f,%.1f,%.1f,%.2f,%.2f,%zu\n", frames_, way_m_,
                  submaps.submaps().size(), submaps.blockCount(), pipeline_->map().usage().blocks,
                  mebibytes(store.memory_bytes), mebibytes(store.disk_bytes), mebibytes(residentBytes()),
                  percentile(times_ms, 0.5), percentile(times_ms, 0.99), left_out_);
    return text;
  }

  void notePoints() {
    const StoreUsage store = pipeline_->submaps().usage();
    const BlockMap::Usage pool = pipeline_->map().usage();
    resident_.points.emplace_back(way_m_, mebibytes(residentBytes()));
    pool_.points.emplace_back(way_m_, mebibytes(pool.bytes));
    store_.points.emplace_back(way_m_, mebibytes(store.memory_bytes + store.disk_bytes));
  }

  void sayStore() {
    const StoreUsage store = pipeline_->submaps().usage();
    std::printf("store: %zu blocks put, %zu brought back; packed %.1f MiB to %.1f at %.0f MiB/s\n",
                static_cast<size_t>(store.blocks_put), static_cast<size_t>(store.blocks_taken),
                mebibytes(store.bytes_packed), mebibytes(store.bytes_of_packed),
                store.packing_s > 0.0 ? mebibytes(store.bytes_packed) / store.packing_s : 0.0);
  }

  void exportMesh() {
    const size_t before = residentBytes();
    PlyWriter writer(options_.output + "/mesh.ply");
    WorldSnapshot world(pipeline_->submaps());
    const MeshStatistics mesh =
        exportWorldMesh(compute_, world, writer, options_.parameters.surface_mesh, world.hasColor());
    std::printf("mesh: %zu vertices; RSS %.0f MiB before its export, %.0f after\n",
                static_cast<size_t>(mesh.size.vertices), mebibytes(before), mebibytes(residentBytes()));
  }

  const LongWalkOptions& options_;
  ComputeContext compute_;
  std::unique_ptr<SimulatedRecording> recording_;
  std::unique_ptr<ReconstructionPipeline> pipeline_;
  size_t frames_ = 0, left_out_ = 0;
  double way_m_ = 0.0;
  Eigen::Vector3d last_W_ = Eigen::Vector3d::Zero();
  PlotLine resident_{"RSS", {}}, pool_{"in the pool", {}}, store_{"elsewhere, compressed", {}};
};

}  // namespace

void addLongWalkBenchmark(CLI::App& app, LongWalkOptions& options) {
  CLI::App* command = app.add_subcommand("long_walk",
                                         "goes through a simulated building at given poses; writes "
                                         "long_walk.csv and .png: blocks, memory and times on "
                                         "the way, and the mesh");
  command->add_option("-o,--output", options.output, "folder of the results")->capture_default_str();
  command->add_option("-s,--scene", options.scene, "as simulate has them")->capture_default_str();
  command->add_option("-w,--walk", options.walk, "the scene's walk; its first unless said");
  command->add_option("-n,--frames", options.frames, "how many frames")->capture_default_str();
  command->add_option("--fps", options.fps, "frames per second")->capture_default_str();
  command->add_option("--width", options.width, "of the images, at most")->capture_default_str();
  command->add_flag("--no-mesh", options.no_mesh, "export no mesh");
  command->add_option("--device", options.device, "part of the name of the OpenCL device");
  command->add_option("--voxel-size", options.parameters.map.voxel_size_m, "in metres")
      ->capture_default_str();
  command->add_option("--pool-mib", options.parameters.map.pool_mib, "map/pool_mib")->capture_default_str();
  command->add_flag("--color", options.parameters.map.color, "the map holds colour");
  command->callback([&options] { LongWalk(options).run(); });
}

}  // namespace depth_fusion
