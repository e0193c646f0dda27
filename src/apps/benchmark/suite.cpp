#include "apps/benchmark/suite.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <iostream>
#include <utility>

#include "apps/benchmark/limit_benchmarks.h"
#include "apps/benchmark/pipeline_benchmarks.h"
#include "apps/benchmark/stage_benchmarks.h"
#include "apps/benchmark/tracking_inputs.h"
#include "depth_fusion/common/error.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

// Repetitions in random order show the spread of a machine that others use. Older libraries do not know all
// of them.
const std::vector<std::string> kDefaultFlags = {
    "--benchmark_repetitions=5",   "--benchmark_enable_random_interleaving=true",
    "--benchmark_min_time=0.1",    "--benchmark_display_aggregates_only=true",
    "--benchmark_out_format=json", "--benchmark_out=benchmark.json"};

constexpr int kRoomFrames = 100;

std::vector<TrackingInput> suiteInputs(TrackingBenchmark options) {
  const std::vector<std::string> chosen = std::exchange(options.inputs, {});
  std::vector<TrackingInput> inputs = {roomInput(kRoomFrames)};
  for (TrackingInput& input : trackingInputs(options)) {
    if (input.name == "tum_fr1_xyz" || input.name == "redkitchen") inputs.push_back(std::move(input));
  }
  std::string names;
  for (const TrackingInput& input : inputs) names += " " + input.name;
  for (const std::string& name : chosen) {
    check(std::any_of(inputs.begin(), inputs.end(), [&](const TrackingInput& i) { return i.name == name; }),
          "there is no input '" + name + "'; the inputs are:" + names);
  }
  const auto left_out = [&](const TrackingInput& input) {
    return !chosen.empty() && std::find(chosen.begin(), chosen.end(), input.name) == chosen.end();
  };
  inputs.erase(std::remove_if(inputs.begin(), inputs.end(), left_out), inputs.end());
  return inputs;
}

void initializeLibrary(const std::vector<std::string>& flags) {
  for (const std::string& flag : flags) {
    check(flag.rfind("--benchmark_", 0) == 0,
          "'" + flag + "' is neither a subcommand nor an option; see --help");
  }
  std::vector<std::string> arguments = {"benchmark"};
  arguments.insert(arguments.end(), kDefaultFlags.begin(), kDefaultFlags.end());
  arguments.insert(arguments.end(), flags.begin(), flags.end());
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  int count = static_cast<int>(pointers.size());
  benchmark::Initialize(&count, pointers.data());
  for (int i = 1; i < count; ++i) {
    check(std::find(kDefaultFlags.begin(), kDefaultFlags.end(), pointers[i]) != kDefaultFlags.end(),
          std::string("google-benchmark does not know ") + pointers[i]);
  }
}

void runSuite(const TrackingBenchmark& options, const std::vector<std::string>& flags) {
  initializeLibrary(flags);
  ComputeContext compute(options.device);
  std::cerr << compute.selfTestReport() << std::endl;
  std::vector<std::unique_ptr<StageFixture>> fixtures;
  for (const TrackingInput& input : suiteInputs(options)) {
    fixtures.push_back(std::make_unique<StageFixture>(compute, input));
    registerStageBenchmarks(*fixtures.back(), input.name);
    registerPipelineBenchmark(compute, input);
  }
  registerLimitBenchmarks(compute);
  benchmark::RunSpecifiedBenchmarks();
}

}  // namespace

void addBenchmarkSuite(CLI::App& app, TrackingBenchmark& options) {
  app.add_option("--data", options.data,
                 "folder of the real recordings [$DEPTH_FUSION_DATA or ../shared/data]");
  app.add_option("--cfg", options.cfg, "folder of the sensors' parameter files")->capture_default_str();
  app.add_option("--device", options.device, "OpenCL device, as of reconstruct");
  app.add_option("--input", options.inputs, "only these inputs: room, tum_fr1_xyz, redkitchen");
  app.allow_extras();
  app.callback([&app, &options] {
    if (app.get_subcommands().empty()) runSuite(options, app.remaining());
  });
  app.footer(
      "Without a subcommand: google-benchmark over every kernel, every stage and the whole pipeline, on a "
      "simulated room and\n"
      "on real recordings; the figures go to benchmark.json (scripts/compare_benchmarks, "
      "scripts/plot_benchmarks). Its own\n"
      "options pass through: --benchmark_filter=REGEX, --benchmark_list_tests, --benchmark_out=FILE, "
      "--benchmark_repetitions=N.");
}

}  // namespace depth_fusion
