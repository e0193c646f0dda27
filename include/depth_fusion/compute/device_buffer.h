// Memory of the compute device.
#pragma once

#include <cstddef>
#include <vector>

struct _cl_mem;  // OpenCL's memory object; its headers stay out of the public interface

namespace depth_fusion {

class ComputeContext;

// A block of device memory, freed with its owner. Transfers run in the order of the context's queue.
class DeviceBuffer {
 public:
  DeviceBuffer() = default;
  // Throws Error naming size and purpose if the device cannot hold it.
  DeviceBuffer(ComputeContext& compute, size_t bytes, const char* purpose);
  ~DeviceBuffer();
  DeviceBuffer(DeviceBuffer&& other) noexcept;
  DeviceBuffer& operator=(DeviceBuffer&& other) noexcept;

  size_t bytes() const { return bytes_; }
  _cl_mem* handle() const { return handle_; }

  void write(const void* source, size_t bytes, size_t offset_bytes = 0);
  // Does not wait: the source stays as it is until the queue has come so far.
  void writeAsync(const void* source, size_t bytes);
  // Waits for the work enqueued before.
  void read(void* destination, size_t bytes, size_t offset_bytes = 0) const;
  // Sets the first `bytes` to copies of a 32-bit pattern.
  void fill(int pattern, size_t bytes);
  // Copies the first `bytes` of another buffer of the same context, on the device.
  void copyFrom(const DeviceBuffer& source, size_t bytes);

  template <class T>
  void write(const std::vector<T>& values) {
    write(values.data(), values.size() * sizeof(T));
  }
  template <class T>
  std::vector<T> read(size_t count, size_t offset_bytes = 0) const {
    std::vector<T> values(count);
    read(values.data(), count * sizeof(T), offset_bytes);
    return values;
  }

 private:
  ComputeContext* compute_ = nullptr;
  _cl_mem* handle_ = nullptr;
  size_t bytes_ = 0;
};

}  // namespace depth_fusion
