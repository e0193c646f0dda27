#include "apps/benchmark/limit_benchmarks.h"

#include <benchmark/benchmark.h>

#include "compute/kernel.h"

namespace depth_fusion {
namespace {

constexpr char kFile[] = "compute/limits.cl";
constexpr size_t kCopyBytes = size_t{128} << 20;  // beyond any cache
constexpr int kItems = 4096;
constexpr int kRounds = 1024;
constexpr int kMultiplyAdds = 8;  // a round and lane, as in limits.cl

using benchmark::Counter;
using benchmark::State;

// The first launch compiles and is not measured.
template <class... Arguments>
void measure(State& state, ComputeContext& compute, Kernel& kernel, size_t items,
             const Arguments&... arguments) {
  kernel.run(items, arguments...);
  compute.finish();
  for (auto _ : state) {
    kernel.run(items, arguments...);
    compute.finish();
  }
}

void launchNothing(State& state, ComputeContext& compute) {
  Kernel kernel(compute, kFile, "do_nothing");
  DeviceBuffer unused(compute, sizeof(float), "a limit");
  measure(state, compute, kernel, 1, unused);
  state.SetLabel(compute.selfTestReport());
}

void copyMemory(State& state, ComputeContext& compute) {
  Kernel kernel(compute, kFile, "copy_memory");
  DeviceBuffer source(compute, kCopyBytes, "a limit"), destination(compute, kCopyBytes, "a limit");
  source.fill(0, kCopyBytes);
  destination.fill(0, kCopyBytes);
  const size_t items = kCopyBytes / sizeof(float) / compute.impl().simd_width;
  measure(state, compute, kernel, items, source, destination);
  state.SetBytesProcessed(state.iterations() * 2 * kCopyBytes);
}

void multiplyAdd(State& state, ComputeContext& compute) {
  Kernel kernel(compute, kFile, "multiply_add");
  const size_t lanes = static_cast<size_t>(kItems) * compute.impl().simd_width;
  DeviceBuffer sums(compute, lanes * sizeof(float), "a limit");
  measure(state, compute, kernel, kItems, sums, kRounds, 0.5f);
  const double flops = 2.0 * kMultiplyAdds * kRounds * static_cast<double>(lanes);
  state.counters["flops"] = Counter(flops * static_cast<double>(state.iterations()), Counter::kIsRate);
}

void gatherWords(State& state, ComputeContext& compute, size_t table_bytes) {
  Kernel kernel(compute, kFile, "gather_words");
  const size_t lanes = static_cast<size_t>(kItems) * compute.impl().simd_width;
  DeviceBuffer table(compute, table_bytes, "a limit"), sums(compute, lanes * sizeof(int), "a limit");
  table.fill(1, table_bytes);
  const int last_index = static_cast<int>(table_bytes / sizeof(int)) - 1;
  measure(state, compute, kernel, kItems, table, sums, kRounds, last_index);
  const double gathers = kRounds * static_cast<double>(lanes);
  state.counters["gathers"] = Counter(gathers * static_cast<double>(state.iterations()), Counter::kIsRate);
}

}  // namespace

void registerLimitBenchmarks(ComputeContext& compute) {
  const auto add = [&compute](const std::string& name, auto run, auto... arguments) {
    const auto body = [&compute, run, arguments...](State& state) { run(state, compute, arguments...); };
    benchmark::RegisterBenchmark(("limit/" + name).c_str(), body)
        ->UseRealTime()
        ->Unit(benchmark::kMicrosecond);
  };
  add("launch", launchNothing);
  add("copy", copyMemory);
  add("multiply_add", multiplyAdd);
  for (const size_t kib : {16, 512, 16384})
    add("gather_" + std::to_string(kib) + "KiB", gatherWords, kib << 10);
}

}  // namespace depth_fusion
