#include "apps/benchmark/pipeline_benchmarks.h"

#include <benchmark/benchmark.h>

#include <utility>

#include "depth_fusion/common/percentile.h"

namespace depth_fusion {
namespace {

using benchmark::State;

void runPipeline(State& state, ComputeContext& compute, const TrackingInput& input) {
  for (auto _ : state) {
    const std::unique_ptr<Recording> recording = input.open();
    std::unique_ptr<ReconstructionPipeline> pipeline;
    int lost = 0;
    for (std::optional<RgbdFrame> frame = recording->next(), next; frame; frame = std::move(next)) {
      next = recording->next();
      if (!pipeline) {
        pipeline = std::make_unique<ReconstructionPipeline>(compute, input.parameters, frame->intrinsics);
      }
      const FrameResult result = pipeline->processFrame(*frame, next ? &*next : nullptr);
      if (result.tracking.status == TrackingStatus::kLost) ++lost;
    }
    for (const auto& [stage, samples] : pipeline->timers().samplesMs()) {
      state.counters["ms:" + stage] = percentile(samples, 0.5);
    }
    const std::vector<double>& frames_ms = pipeline->timers().samplesMs().at("frame");
    state.counters["p95_ms"] = percentile(frames_ms, 0.95);
    state.counters["frames"] = static_cast<double>(frames_ms.size());
    state.counters["lost"] = lost;
    state.SetIterationTime(1e-3 * percentile(frames_ms, 0.5));
  }
}

}  // namespace

void registerPipelineBenchmark(ComputeContext& compute, const TrackingInput& input) {
  benchmark::RegisterBenchmark(("pipeline_overlapped/" + input.name).c_str(),
                               [&compute, input](State& state) { runPipeline(state, compute, input); })
      ->UseManualTime()
      ->Iterations(1)
      ->Unit(benchmark::kMillisecond);
}

}  // namespace depth_fusion
