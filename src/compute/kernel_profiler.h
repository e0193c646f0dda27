// How long each launch of a kernel takes on the device, for benchmarks.
#pragma once

#include <string>
#include <vector>

#include "compute/opencl.h"

namespace depth_fusion {

struct KernelLaunch {
  std::string kernel;
  size_t work_items;
  double seconds;  // from its start to its end on the device
};

// Notes the launches in a context as long as it lives.
class KernelProfiler {
 public:
  explicit KernelProfiler(ComputeContext& compute);
  ~KernelProfiler();
  KernelProfiler(const KernelProfiler&) = delete;
  KernelProfiler& operator=(const KernelProfiler&) = delete;

  void note(const std::string& kernel, const cl::NDRange& global, const cl::Event& event);
  // Waits for the launches since the last call and returns them in their order.
  std::vector<KernelLaunch> take();

 private:
  struct Noted {
    std::string kernel;
    size_t work_items;
    cl::Event event;
  };

  ComputeContext::Impl& compute_;
  cl::CommandQueue queue_;  // the context's, which does not measure
  std::vector<Noted> noted_;
};

}  // namespace depth_fusion
