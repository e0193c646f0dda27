// The OpenCL device that everything runs on.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace depth_fusion {

struct DeviceInfo {
  std::string name;
  std::string platform;
  std::string version;
  bool is_cpu = false;
  size_t memory_bytes = 0;
};

// One device, its context, its in-order command queue and the programs built for it.
class ComputeContext {
 public:
  // Every OpenCL device of every platform; empty if there is none.
  static std::vector<DeviceInfo> listDevices();

  // choice: empty = the first device that passes the self-test, GPUs before CPUs; a number = index in
  // listDevices(); "gpu" or "cpu"; or a part of a device's name (any case). Empty falls back on the
  // environment variable DEPTH_FUSION_DEVICE. Throws Error if no device fits, saying why each was refused.
  // simd_width: pixels or voxels that a work-item handles, 1, 8 or 16; 0 = 1 on GPUs, what the vector unit
  // holds on CPUs. group_size: most work-items of a work-group, a power of two; 0 = 64, or what the device
  // takes if that is less.
  explicit ComputeContext(const std::string& choice = "", int simd_width = 0, int group_size = 0);
  // A queue of its own on the same device: what runs there and what runs here do not wait for each other.
  // Either may read the other's buffers once nothing is enqueued that changes them.
  std::unique_ptr<ComputeContext> anotherQueue();
  ~ComputeContext();
  ComputeContext(const ComputeContext&) = delete;
  ComputeContext& operator=(const ComputeContext&) = delete;

  const DeviceInfo& device() const;
  // One line: the device in use, and each one tried before it with the reason why it was refused.
  const std::string& selfTestReport() const;
  // Waits until all the work enqueued so far is done.
  void finish();

  struct Impl;
  Impl& impl() { return *impl_; }

 private:
  explicit ComputeContext(std::unique_ptr<Impl> impl);

  std::unique_ptr<Impl> impl_;
};

}  // namespace depth_fusion
