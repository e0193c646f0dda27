// Benchmarks whose tables and pictures stand in docs/. A subcommand each, in benchmark/.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "apps/benchmark/filters.h"

int main(int argc, char** argv) {
  CLI::App app("Measures depth_fusion; writes tables and pictures.");
  app.require_subcommand(1);
  depth_fusion::addFiltersBenchmark(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "benchmark: %s\n", error.what());
    return 1;
  }
  return 0;
}
