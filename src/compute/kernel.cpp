#include "compute/kernel.h"

namespace depth_fusion {

Kernel::Kernel(ComputeContext& compute, const std::string& file, const std::string& name,
               const std::string& options)
    : compute_(&compute.impl()), name_(name) {
  const cl::Program& program = compute_->program(file, options);
  try {
    kernel_ = cl::Kernel(program, name.c_str());
  } catch (const cl::Error& error) {
    throw Error("OpenCL kernel " + name + " of " + file + ": " + error.what() + ": " + statusText(error.err()));
  }
}

}  // namespace depth_fusion
