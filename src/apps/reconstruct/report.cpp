#include "apps/reconstruct/report.h"

#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "common/io/text_file.h"
#include "depth_fusion/common/percentile.h"

namespace depth_fusion {
namespace {

nlohmann::ordered_json parametersJson(PipelineParameters parameters) {
  nlohmann::ordered_json json;
  for (const Parameter& parameter : parameters.table()) {
    std::visit([&](const auto* value) { json[parameter.name] = *value; }, parameter.value);
  }
  return json;
}

nlohmann::ordered_json statisticsJson(const std::vector<double>& samples_ms) {
  return {{"median", percentile(samples_ms, 0.5)}, {"p95", percentile(samples_ms, 0.95)}};
}

nlohmann::ordered_json trackingJson(const RunCounts& counts, const ReconstructionPipeline& pipeline) {
  nlohmann::ordered_json losses = nlohmann::ordered_json::array();
  for (const Loss& loss : counts.losses) {
    losses.push_back({{"first_frame", loss.first_frame}, {"frames", loss.frames}, {"reason", loss.reason}});
  }
  return {{"states",
           {{"tracking", counts.tracked - counts.degenerate},
            {"degenerate", counts.degenerate},
            {"lost", counts.lost}}},
          {"losses", losses},
          {"map_doubt", counts.map_doubt},
          {"keyframes", pipeline.keyframeCount()}};
}

MapParameters withoutColor(MapParameters map) {
  map.color = false;
  return map;
}

}  // namespace

size_t peakRssBytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<size_t>(usage.ru_maxrss) * 1024;
}

void writeReport(const std::string& path, const std::string& input, ComputeContext& compute,
                 ReconstructionPipeline& pipeline, const RunCounts& counts, size_t tracking_peak_rss_bytes) {
  const BlockMap::Usage pool = pipeline.map().usage();
  const SubmapCollection& submaps = pipeline.submaps();
  const size_t blocks = submaps.blockCount();
  const MapParameters& map = pipeline.map().parameters();
  nlohmann::ordered_json stages;
  nlohmann::ordered_json frame;
  for (const auto& [stage, samples_ms] : pipeline.timers().samplesMs()) {
    (stage == "frame" ? frame : stages[stage]) = statisticsJson(samples_ms);
  }
  const nlohmann::ordered_json report = {
      {"input", input},
      {"device", compute.selfTestReport()},
      {"parameters", parametersJson(pipeline.parameters())},
      {"frames",
       {{"read", counts.read},
        {"tracked", counts.tracked},
        {"lost", counts.lost},
        {"unreadable", counts.unreadable},
        {"colored", counts.colored}}},
      {"tracking", trackingJson(counts, pipeline)},
      {"loops", {{"closed", counts.loops}, {"moved_m", counts.moved_by_loops_m}}},
      {"frame_ms", frame},
      {"stage_ms", stages},
      {"map",
       {{"blocks", blocks},
        {"blocks_in_pool", pool.blocks},
        {"capacity", pool.capacity},
        {"submaps", submaps.submaps().size()},
        {"bytes", mapBytes(map, blocks)},
        {"color_bytes", mapBytes(map, blocks) - mapBytes(withoutColor(map), blocks)},
        {"pool_bytes", pool.pool_bytes}}},
      {"peak_rss_bytes", peakRssBytes()},
      {"tracking_peak_rss_bytes", tracking_peak_rss_bytes}};
  writeText(path, report.dump(2) + '\n');
}

}  // namespace depth_fusion
