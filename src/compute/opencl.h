// The OpenCL headers, as this project uses them, and what a ComputeContext holds.
#pragma once

#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_TARGET_OPENCL_VERSION 120
#if __has_include(<CL/opencl.hpp>)
#include <CL/opencl.hpp>
#else
#include <CL/cl2.hpp>
#endif

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "depth_fusion/compute/compute_context.h"

namespace depth_fusion {

class KernelProfiler;

// Programs are known by their file and options.
struct BuiltPrograms {
  std::map<std::string, cl::Program> programs;
  std::mutex mutex;
};

struct ComputeContext::Impl {
  cl::Device device;
  cl::Context context;
  cl::CommandQueue queue;
  DeviceInfo info;
  std::string report;
  int simd_width = 1;                  // pixels or voxels a work-item handles at a time
  size_t group_size = 1;               // most work-items of a work-group, a power of two
  KernelProfiler* profiler = nullptr;  // notes the launches, if there is one
  std::shared_ptr<BuiltPrograms> built = std::make_shared<BuiltPrograms>();  // of all the context's queues

  // Builds the program once, for any thread. file: path below kernels/. Throws Error with the build log.
  const cl::Program& program(const std::string& file, const std::string& options);
};

// The largest power of two up to a limit of 1 or more.
constexpr size_t powerOfTwoWithin(size_t limit) { return limit < 2 ? 1 : 2 * powerOfTwoWithin(limit / 2); }

// Text of an OpenCL status code.
std::string statusText(cl_int status);

}  // namespace depth_fusion
