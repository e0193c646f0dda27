// A kernel as a function. Private to the stages: their typed launches stand in <stage>_kernels.cpp.
#pragma once

#include <algorithm>
#include <string>

#include "compute/opencl.h"
#include "depth_fusion/common/error.h"
#include "depth_fusion/compute/device_buffer.h"

namespace depth_fusion {

class Kernel {
 public:
  Kernel(ComputeContext& compute, const std::string& file, const std::string& name,
         const std::string& options = "");

  // Runs work-items [0, count), and up to a work-group's size beyond: the kernel tests its index.
  template <class... Arguments>
  void run(size_t count, const Arguments&... arguments) {
    enqueue(cl::NDRange(roundUp(count, group_size_)), cl::NDRange(group_size_), arguments...);
  }

  // Runs work-items [0, columns) x [0, rows), and up to a work-group's width beyond in columns.
  template <class... Arguments>
  void run2d(size_t columns, size_t rows, const Arguments&... arguments) {
    const size_t group_width =
        compute_->simd_width == 1 ? group_size_ : std::min(group_size_, kVectorsAcross);
    enqueue(cl::NDRange(roundUp(columns, group_width), rows), cl::NDRange(group_width, 1), arguments...);
  }

  // Runs `groups` work-groups of exactly group_size work-items, ComputeContext::Impl::group_size at most.
  template <class... Arguments>
  void runGroups(size_t groups, size_t group_size, const Arguments&... arguments) {
    enqueue(cl::NDRange(groups * group_size), cl::NDRange(group_size), arguments...);
  }

 private:
  static constexpr size_t kVectorsAcross = 4;  // of a row, that a work-group takes

  static size_t roundUp(size_t count, size_t multiple) {
    return (count + multiple - 1) / multiple * multiple;
  }

  template <class T>
  void setArgument(cl_uint index, const T& value) {
    static_assert(std::is_trivially_copyable<T>::value, "kernel arguments are plain data or DeviceBuffers");
    kernel_.setArg(index, sizeof(T), &value);
  }
  void setArgument(cl_uint index, const DeviceBuffer& buffer) {
    cl_mem handle = buffer.handle();
    kernel_.setArg(index, sizeof(handle), &handle);
  }

  template <class... Arguments>
  void enqueue(const cl::NDRange& global, const cl::NDRange& local, const Arguments&... arguments) {
    if (global[0] == 0) return;
    try {
      cl_uint index = 0;
      (setArgument(index++, arguments), ...);
      launch(global, local);
    } catch (const cl::Error& error) {
      throw Error("OpenCL kernel " + name_ + ": " + error.what() + ": " + statusText(error.err()));
    }
  }

  void launch(const cl::NDRange& global, const cl::NDRange& local);

  ComputeContext::Impl* compute_;
  cl::Kernel kernel_;
  std::string name_;
  size_t group_size_;  // most work-items of a work-group that the device takes for this kernel
};

}  // namespace depth_fusion
