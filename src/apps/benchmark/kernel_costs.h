// What kernels must move and compute at least, estimated from their source. With the limits of the device
// (limit/*) this tells how much faster a kernel could be.
#pragma once

#include <optional>
#include <string>

#include "apps/benchmark/stage_fixture.h"

namespace depth_fusion {

struct KernelCost {
  std::string element;  // what the figures below are for: pixel, voxel, ray, ...
  double work_item;     // elements of a work-item
  double bytes;         // read and written, each once; those of gathers are in caches
  double flops;         // a multiply-add is two
  double gathers;       // words from places that data decide
};

// Returns nothing for kernels that it does not pay to estimate.
std::optional<KernelCost> kernelCost(const std::string& kernel, const StageFixture::Stage& stage,
                                     StageFixture& fixture);

}  // namespace depth_fusion
