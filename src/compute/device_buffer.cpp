#include "depth_fusion/compute/device_buffer.h"

#include <utility>

#include "compute/opencl.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

void checkStatus(cl_int status, const std::string& call) {
  check(status == CL_SUCCESS, "OpenCL " + call + ": " + statusText(status));
}

}  // namespace

DeviceBuffer::DeviceBuffer(ComputeContext& compute, size_t bytes, const char* purpose)
    : compute_(&compute), bytes_(bytes) {
  cl_int status = CL_SUCCESS;
  handle_ = clCreateBuffer(compute.impl().context(), CL_MEM_READ_WRITE, bytes, nullptr, &status);
  check(status == CL_SUCCESS,
        "device memory for " + std::string(purpose) + ", " + std::to_string(bytes >> 20) + " MiB of " +
            std::to_string(compute.device().memory_bytes >> 20) + " MiB: " + statusText(status) +
            "; ask for a smaller map or another --device");
}

DeviceBuffer::~DeviceBuffer() {
  if (handle_ != nullptr) clReleaseMemObject(handle_);
}

DeviceBuffer::DeviceBuffer(DeviceBuffer&& other) noexcept { *this = std::move(other); }

DeviceBuffer& DeviceBuffer::operator=(DeviceBuffer&& other) noexcept {
  std::swap(compute_, other.compute_);
  std::swap(handle_, other.handle_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

void DeviceBuffer::write(const void* source, size_t bytes, size_t offset_bytes) {
  if (bytes == 0) return;
  checkStatus(clEnqueueWriteBuffer(compute_->impl().queue(), handle_, CL_TRUE, offset_bytes, bytes, source, 0,
                                   nullptr, nullptr),
              "clEnqueueWriteBuffer");
}

void DeviceBuffer::writeAsync(const void* source, size_t bytes) {
  if (bytes == 0) return;
  checkStatus(clEnqueueWriteBuffer(compute_->impl().queue(), handle_, CL_FALSE, 0, bytes, source, 0, nullptr,
                                   nullptr),
              "clEnqueueWriteBuffer");
}

void DeviceBuffer::read(void* destination, size_t bytes, size_t offset_bytes) const {
  if (bytes == 0) return;
  checkStatus(clEnqueueReadBuffer(compute_->impl().queue(), handle_, CL_TRUE, offset_bytes, bytes,
                                  destination, 0, nullptr, nullptr),
              "clEnqueueReadBuffer");
}

void DeviceBuffer::fill(int pattern, size_t bytes) {
  if (bytes == 0) return;
  checkStatus(clEnqueueFillBuffer(compute_->impl().queue(), handle_, &pattern, sizeof(pattern), 0, bytes, 0,
                                  nullptr, nullptr),
              "clEnqueueFillBuffer");
}

void DeviceBuffer::copyFrom(const DeviceBuffer& source, size_t bytes) {
  if (bytes == 0) return;
  checkStatus(clEnqueueCopyBuffer(compute_->impl().queue(), source.handle(), handle_, 0, 0, bytes, 0, nullptr,
                                  nullptr),
              "clEnqueueCopyBuffer");
}

}  // namespace depth_fusion
