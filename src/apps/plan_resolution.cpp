// plan_resolution finds which N and M to map with, from what a recording or a mesh takes.
#include <cstdio>
#include <filesystem>

#include "apps/command_line.h"
#include "apps/plan_resolution/count.h"
#include "common/io/image_file.h"
#include "common/io/text_file.h"
#include "depth_fusion/common/error.h"
#include "tools/plots/memory_plot.h"

namespace depth_fusion {
namespace {

constexpr char kDescription[] =
    "Says how many blocks of how many voxels (N, M) to map with: counts the blocks that the surface meets "
    "for each\n"
    "choice, prints the memory they take, draws it (memory.png) and writes the best choice (map.yaml) for\n"
    "reconstruct --params.\n\n"
    "Examples:\n"
    "  plan_resolution --input desk --output plan --box 4 --voxel-size 0.002\n"
    "  plan_resolution --input mesh.ply --output plan --limit 512\n";

struct Options {
  CountingOptions counting;
  PlanRequest request;
  std::string output;
  RecordingArguments arguments;
  size_t limit_mib = 1536;
  bool no_trial = false;
};

void addOptions(CLI::App& app, Options& options) {
  CountingOptions& counting = options.counting;
  app.add_option("--input", counting.inputs, "a recording as of reconstruct, or a mesh (.ply)")->required();
  app.add_option("--output", options.output, "folder for table, figure and map.yaml; made if missing")
      ->required();
  app.add_option("--box", options.request.box_m, "edge of the window in metres")->capture_default_str();
  app.add_option("--voxel-size", options.request.wished_voxel_m, "edge of a voxel that is wished, in metres")
      ->capture_default_str();
  app.add_option("--limit", options.limit_mib, "memory that the map may take, MiB")
      ->check(CLI::Range(1, 1 << 20))
      ->capture_default_str();
  app.add_option("--trajectory", counting.trajectory_file,
                 "the poses (TUM format, or a folder that holds poses); tracked if not given");
  addRecordingOptions(app, options.arguments, counting.recording);
  app.add_option("--max-range", counting.parameters.preprocessing.max_range_m, "farthest depth used, metres")
      ->capture_default_str();
  app.add_option("--max-frames", counting.max_frames, "stop after so many frames")
      ->check(CLI::Range(1, 1000000000));
  app.add_option("--device", counting.device, "OpenCL device, as of reconstruct");
  app.add_flag("--no-trial", options.no_trial,
               "by counting alone, without fusing a recording with the best choice; takes noise that fusion "
               "carves away "
               "again for surface, which is much if voxels are small");
  app.add_flag("--color", counting.parameters.map.color, "with colour, six bytes a voxel in place of two");
}

std::string tableRow(const PlanRow& row, const PlanRequest& request) {
  char blocks[32] = "-", text[200];
  if (row.counted) std::snprintf(blocks, sizeof(blocks), "%zu", row.blocks);
  std::snprintf(text, sizeof(text), "%s,%d,%d,%.3f,%s,%zu,%s\n",
                std::to_string(row.map.blocks_per_axis * row.map.block_size).c_str(), row.map.blocks_per_axis,
                row.map.block_size, 1000.0 * row.map.voxel_size_m, blocks, row.bytes,
                fits(row, request) ? "yes" : "no");
  return text;
}

std::string table(const ResolutionPlan& plan) {
  std::string text = "voxels per axis,N,M,voxel [mm],blocks,bytes,fits\n";
  for (const PlanRow& row : plan.rows) text += tableRow(row, plan.request);
  return text;
}

void printTable(const ResolutionPlan& plan) {
  std::printf("%8s %5s %3s %9s %11s %10s\n", "voxels", "N", "M", "voxel/mm", "blocks", "MiB");
  for (const PlanRow& row : plan.rows) {
    std::printf("%8d %5d %3d %9.3f %11s %s%9.1f%s\n", row.map.blocks_per_axis * row.map.block_size,
                row.map.blocks_per_axis, row.map.block_size, 1000.0 * row.map.voxel_size_m,
                row.counted ? std::to_string(row.blocks).c_str() : "-", row.counted ? " " : ">",
                static_cast<double>(row.bytes) / (1 << 20),
                fits(row, plan.request) ? "" : "  over the limit");
  }
}

// The row as a file of parameters, which reconstruct --params reads.
std::string mapYaml(const PlanRow& row) {
  char text[200];
  std::snprintf(text, sizeof(text),
                "map: {voxel_size_m: %.9g, blocks_per_axis: %d, block_size: %d, pool_mib: %d}\n",
                row.map.voxel_size_m, row.map.blocks_per_axis, row.map.block_size, poolMebibytes(row));
  return text;
}

// Returns the best choice after a trial of each that was the best so far, for one may turn out to be too
// large.
const PlanRow& tryBest(ResolutionPlan& plan, BlockCounting& counting, bool trial) {
  PlanRow* best = recommended(plan);
  while (trial && best != nullptr && !best->tried) {
    counting.tryOut(*best);
    best->tried = true;
    best = recommended(plan);
  }
  check(best != nullptr, "no choice fits into the limit; raise --limit or make --box smaller");
  return *best;
}

void writeChoice(const PlanRow& best, const PlanRequest& request, const std::string& path) {
  const double voxel_m = best.map.voxel_size_m;
  if (voxel_m > 1.001 * request.wished_voxel_m)
    std::printf("the wished voxels of %.3g mm do not fit; the finest that do:\n",
                1000.0 * request.wished_voxel_m);
  std::printf("recommended: N %d, M %d, voxels of %.4g mm: %zu blocks, %zu bytes (%.1f MiB)\n",
              best.map.blocks_per_axis, best.map.block_size, 1000.0 * voxel_m, best.blocks, best.bytes,
              static_cast<double>(best.bytes) / (1 << 20));
  writeText(path, mapYaml(best));
  std::printf("written: %s, for reconstruct --params\n", path.c_str());
}

void plan(Options& options) {
  options.request.limit_bytes = options.limit_mib << 20;
  options.request.map = options.counting.parameters.map;
  ResolutionPlan plan = resolutionChoices(options.request);
  BlockCounting counting(options.counting);
  std::error_code error;
  std::filesystem::create_directories(options.output, error);
  check(!error, "the output folder " + options.output + " cannot be made (" + error.message() + ")");
  counting.count(plan);
  const PlanRow& best = tryBest(plan, counting, !options.no_trial);
  printTable(plan);
  writeText(options.output + "/memory.csv", table(plan));
  writePicture(options.output + "/memory.png", plotMemory(plan));
  writeChoice(best, options.request, options.output + "/map.yaml");
}

}  // namespace
}  // namespace depth_fusion

int main(int argc, char** argv) {
  CLI::App app(depth_fusion::kDescription, "plan_resolution");
  depth_fusion::Options options;
  addOptions(app, options);
  return depth_fusion::runApp(app, [&] {
    depth_fusion::CountingOptions& counting = options.counting;
    parse(app, argc, argv, options.arguments, counting.parameters.table(), counting.recording);
    validate(counting.parameters.table());
    plan(options);
    return 0;
  });
}
