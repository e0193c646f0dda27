#include "compute/kernel.h"

#include "compute/kernel_profiler.h"

namespace depth_fusion {

Kernel::Kernel(ComputeContext& compute, const std::string& file, const std::string& name,
               const std::string& options)
    : compute_(&compute.impl()), name_(name) {
  const cl::Program& program = compute_->program(file, options);
  try {
    kernel_ = cl::Kernel(program, name.c_str());
    const size_t limit = kernel_.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(compute_->device);
    group_size_ = powerOfTwoWithin(std::min(compute_->group_size, limit));
  } catch (const cl::Error& error) {
    throw Error("OpenCL kernel " + name + " of " + file + ": " + error.what() + ": " +
                statusText(error.err()));
  }
}

void Kernel::launch(const cl::NDRange& global, const cl::NDRange& local) {
  cl::Event event;
  compute_->queue.enqueueNDRangeKernel(kernel_, cl::NullRange, global, local, nullptr,
                                       compute_->profiler == nullptr ? nullptr : &event);
  if (compute_->profiler != nullptr) compute_->profiler->note(name_, global, event);
}

}  // namespace depth_fusion
