#include "apps/benchmark/stage_benchmarks.h"

#include <benchmark/benchmark.h>

#include <map>
#include <set>

#include "apps/benchmark/kernel_costs.h"
#include "compute/kernel_profiler.h"

namespace depth_fusion {
namespace {

using benchmark::Counter;
using benchmark::State;
using Stage = StageFixture::Stage;

// A part or a kernel runs with its whole stage: so many times are enough.
constexpr int kPartRuns = 20;

void runStage(State& state, StageFixture& fixture, const Stage& stage) {
  fixture.run(stage);
  for (auto _ : state) fixture.run(stage);
}

void runPart(State& state, StageFixture& fixture, const Stage& stage, const std::string& part) {
  fixture.run(stage);
  for (auto _ : state) {
    fixture.run(stage);
    state.SetIterationTime(1e-3 * fixture.timers().samplesMs().at(part).back());
  }
}

// Names a kernel of a stage, on one level of the pyramid or wherever the stage launches it.
struct StageKernel {
  std::string name;
  std::string kernel;
  std::optional<size_t> level_items;  // work-items of a launch on the level
};

struct Work {
  double seconds = 0.0;
  double items = 0.0;
};

// Returns the work of the kernel's launches together, or of the mean one on a level.
Work workOf(const StageKernel& measured, const std::vector<KernelLaunch>& launches) {
  Work work;
  int count = 0;
  for (const KernelLaunch& launch : launches) {
    if (launch.kernel != measured.kernel ||
        launch.work_items != measured.level_items.value_or(launch.work_items))
      continue;
    work.seconds += launch.seconds;
    work.items += static_cast<double>(launch.work_items);
    ++count;
  }
  if (measured.level_items && count > 0) return {work.seconds / count, work.items / count};
  return work;
}

void countWork(State& state, const KernelCost& cost, const Work& total) {
  const double elements = cost.work_item * total.items;
  state.counters["ns_per_" + cost.element] = 1e9 * total.seconds / elements;
  state.counters["bytes_per_second"] = Counter(cost.bytes * elements, Counter::kIsRate);
  state.counters["flops"] = Counter(cost.flops * elements, Counter::kIsRate);
  if (cost.gathers > 0.0) state.counters["gathers"] = Counter(cost.gathers * elements, Counter::kIsRate);
}

void runKernel(State& state, StageFixture& fixture, const Stage& stage, const StageKernel& kernel) {
  KernelProfiler profiler(fixture.compute());
  fixture.run(stage);
  profiler.take();
  Work total;
  for (auto _ : state) {
    fixture.run(stage);
    const Work work = workOf(kernel, profiler.take());
    state.SetIterationTime(work.seconds);
    total.seconds += work.seconds;
    total.items += work.items;
  }
  const std::optional<KernelCost> cost = kernelCost(kernel.kernel, stage, fixture);
  if (cost && total.items > 0.0) countWork(state, *cost, total);
}

std::vector<StageKernel> kernelsOf(StageFixture& fixture, const Stage& stage) {
  KernelProfiler profiler(fixture.compute());
  fixture.run(stage);
  std::map<std::string, std::set<size_t, std::greater<size_t>>> sizes;
  for (const KernelLaunch& launch : profiler.take()) sizes[launch.kernel].insert(launch.work_items);
  std::vector<StageKernel> kernels;
  for (const auto& [kernel, of_kernel] : sizes) {
    if (!stage.has_levels || of_kernel.size() == 1) {
      kernels.push_back({kernel, kernel, std::nullopt});
      continue;
    }
    int level = 0;
    for (const size_t items : of_kernel)
      kernels.push_back({kernel + "/level" + std::to_string(level++), kernel, items});
  }
  return kernels;
}

}  // namespace

void registerStageBenchmarks(StageFixture& fixture, const std::string& input) {
  for (const Stage& stage : StageFixture::stages()) {
    benchmark::RegisterBenchmark(("stage/" + stage.name + "/" + input).c_str(),
                                 [&fixture, stage](State& state) { runStage(state, fixture, stage); })
        ->UseRealTime()
        ->Unit(benchmark::kMicrosecond);
    const auto addPart = [&](const std::string& name, auto body) {
      benchmark::RegisterBenchmark((name + "/" + input).c_str(), body)
          ->UseManualTime()
          ->Iterations(kPartRuns)
          ->Unit(benchmark::kMicrosecond);
    };
    for (const StageKernel& kernel : kernelsOf(fixture, stage)) {
      addPart("kernel/" + stage.name + "/" + kernel.name,
              [&fixture, stage, kernel](State& state) { runKernel(state, fixture, stage, kernel); });
    }
    for (const auto& [part, samples] : fixture.timers().samplesMs()) {
      if (part == stage.name) continue;
      addPart("stage/" + part,
              [&fixture, stage, part = part](State& state) { runPart(state, fixture, stage, part); });
    }
  }
}

}  // namespace depth_fusion
