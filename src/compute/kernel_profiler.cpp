#include "compute/kernel_profiler.h"

namespace depth_fusion {

KernelProfiler::KernelProfiler(ComputeContext& compute) : compute_(compute.impl()), queue_(compute_.queue) {
  queue_.finish();
  compute_.queue = cl::CommandQueue(compute_.context, compute_.device, CL_QUEUE_PROFILING_ENABLE);
  compute_.profiler = this;
}

KernelProfiler::~KernelProfiler() {
  compute_.queue.finish();
  compute_.queue = queue_;
  compute_.profiler = nullptr;
}

void KernelProfiler::note(const std::string& kernel, const cl::NDRange& global, const cl::Event& event) {
  const size_t rows = global.dimensions() > 1 ? global[1] : 1;
  noted_.push_back({kernel, global[0] * rows, event});
}

std::vector<KernelLaunch> KernelProfiler::take() {
  compute_.queue.finish();
  std::vector<KernelLaunch> launches;
  for (const Noted& noted : noted_) {
    const cl_ulong nanoseconds = noted.event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                                 noted.event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
    launches.push_back({noted.kernel, noted.work_items, 1e-9 * static_cast<double>(nanoseconds)});
  }
  noted_.clear();
  return launches;
}

}  // namespace depth_fusion
