#include "apps/reconstruct/results.h"

#include <functional>
#include <iostream>

#include "apps/reconstruct/page.h"
#include "depth_fusion/submaps/world_mesh.h"
#include "depth_fusion/surface_mesh/ply.h"

namespace depth_fusion {
namespace {

void saveMap(ReconstructionPipeline& pipeline, MapSaver& saver) {
  const SaveReport saved = pipeline.save(saver);
  std::cout << saved.place << ": " << saved.blocks << " blocks, " << saved.bytes << " bytes" << std::endl;
}

void sayMesh(const RunOptions& options, ComputeContext& compute, ReconstructionPipeline& pipeline) {
  const StageTimers::Scope timer(pipeline.timers(), "surface_mesh");
  const MeshStatistics mesh = writeMesh(options, compute, pipeline);
  std::cout << options.output << "/mesh.ply: " << mesh.size.vertices << " vertices, " << mesh.size.triangles
            << " triangles" << std::endl;
}

void attempt(RunLog& log, const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& error) {
    log.complain(error.what());
  }
}

}  // namespace

MeshStatistics writeMesh(const RunOptions& options, ComputeContext& compute,
                         ReconstructionPipeline& pipeline) {
  PlyWriter writer(options.output + "/mesh.ply");
  WorldSnapshot world(pipeline.submaps());
  return exportWorldMesh(compute, world, writer, options.parameters.surface_mesh, world.hasColor());
}

void writeResults(const RunOptions& options, ComputeContext& compute, ReconstructionPipeline& pipeline,
                  MapSaver* saver, RunLog& log) {
  const std::string folder = options.output + "/";
  const size_t tracking_peak_rss_bytes = peakRssBytes();
  attempt(log, [&] { writeTrajectory(folder + "trajectory.txt", log.trajectory()); });
  if (saver != nullptr && log.counts().tracked > 0) attempt(log, [&] { saveMap(pipeline, *saver); });
  if (!options.no_mesh) attempt(log, [&] { sayMesh(options, compute, pipeline); });
  attempt(log, [&] {
    writeReport(folder + "report.json", log.input(), compute, pipeline, log.counts(),
                tracking_peak_rss_bytes);
  });
  if (options.report) attempt(log, [&] { writePage(options, compute, pipeline, log); });
}

}  // namespace depth_fusion
