// The paper's two experiments on the filters of fusion, through the real kernels.
#pragma once

namespace CLI {
class App;
}

namespace depth_fusion {

// Adds the subcommand `filters`.
void addFiltersBenchmark(CLI::App& app);

}  // namespace depth_fusion
