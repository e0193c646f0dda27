// Makes one map of two.
#include <cstdio>

#include "apps/command_line.h"
#include "depth_fusion/pipeline/map_merging.h"

namespace depth_fusion {
namespace {

constexpr char kDescription[] =
    "Makes one map of two that were saved, of two sessions or two robots, by what both have seen: the "
    "second\n"
    "is fused into the first. The exit status is 1, and nothing is written, if they show no overlap.\n\n"
    "Examples:\n"
    "  merge_maps ground_floor.map staircase.map --output house.map\n"
    "  merge_maps 'postgresql://robots@maps/robots#one' 'postgresql://robots@maps/robots#two' -o both.map\n";

struct Arguments {
  std::string first, second, output, device;
  std::vector<std::string> parameter_files;
  PipelineParameters parameters;
};

int merge(Arguments& arguments) {
  for (const std::string& file : arguments.parameter_files)
    loadParameterFile(arguments.parameters.table(), file);
  check(arguments.output != arguments.first && arguments.output != arguments.second,
        "the output is one of the two maps; give another place, so that both are left as they are");
  checkPlace(arguments.output);
  const auto first = openDatabase(arguments.first, DatabaseAccess::kRead);
  const auto second = openDatabase(arguments.second, DatabaseAccess::kRead);
  ComputeContext compute(arguments.device);
  MapSaver saver(arguments.output);
  const MergedMaps merged = mergeMaps(compute, arguments.parameters, *first, *second, saver, [](double done) {
    std::fprintf(stderr, "\rmerging: %3.0f %%", 100.0 * done);
  });
  std::fprintf(stderr, "\n");
  const Eigen::Vector3d t = merged.overlap.T_A_B.translation();
  const Eigen::Quaterniond q(merged.overlap.T_A_B.linear());
  std::printf("overlap:    %zu keyframes agree, of %zu that fit, to %.1f mm\n", merged.overlap.agreeing,
              merged.overlap.fitting, 1000.0 * merged.overlap.spread_m);
  std::printf("second map: at %.4f %.4f %.4f m, turned by %.5f %.5f %.5f %.5f (x y z w)\n", t.x(), t.y(),
              t.z(), q.x(), q.y(), q.z(), q.w());
  std::printf("saved:      %s, %llu blocks, %llu bytes\n", merged.saved.place.c_str(),
              static_cast<unsigned long long>(merged.saved.blocks),
              static_cast<unsigned long long>(merged.saved.bytes));
  return 0;
}

}  // namespace
}  // namespace depth_fusion

int main(int argc, char** argv) {
  using namespace depth_fusion;
  CLI::App app(kDescription, "merge_maps");
  Arguments arguments;
  app.add_option("first", arguments.first, "the map whose world the result has")->required();
  app.add_option("second", arguments.second, "the map that is fused into it")->required();
  app.add_option("-o,--output", arguments.output, "where the result is saved")->required();
  app.add_option("--params", arguments.parameter_files,
                 "YAML files of `stage: {name: value}`, as reconstruct's");
  app.add_option("--device", arguments.device, "OpenCL device: index, part of its name, cpu or gpu");
  return runApp(app, [&] {
    app.parse(argc, argv);
    return merge(arguments);
  });
}
