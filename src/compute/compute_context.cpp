#include "depth_fusion/compute/compute_context.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <numeric>

#include "common/lowered.h"
#include "compute/kernel.h"
#include "compute/opencl.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

std::vector<cl::Device> allDevices() {
  std::vector<cl::Device> devices;
  try {
    std::vector<cl::Platform> platforms;
    cl::Platform::get(&platforms);
    for (const cl::Platform& platform : platforms) {
      std::vector<cl::Device> of_platform;
      try {
        platform.getDevices(CL_DEVICE_TYPE_ALL, &of_platform);
      } catch (const cl::Error&) {
        continue;  // a platform without devices reports CL_DEVICE_NOT_FOUND
      }
      devices.insert(devices.end(), of_platform.begin(), of_platform.end());
    }
  } catch (const cl::Error&) {
    // no platform at all: the list stays empty and the caller says so
  }
  return devices;
}

DeviceInfo infoOf(const cl::Device& device) {
  DeviceInfo info;
  info.name = device.getInfo<CL_DEVICE_NAME>();
  info.version = device.getInfo<CL_DEVICE_VERSION>();
  info.platform = cl::Platform(device.getInfo<CL_DEVICE_PLATFORM>()).getInfo<CL_PLATFORM_NAME>();
  info.is_cpu = (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU) != 0;
  info.memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
  return info;
}

bool matches(const std::string& choice, size_t index, const DeviceInfo& info) {
  if (choice.empty()) return true;
  if (std::all_of(choice.begin(), choice.end(), [](unsigned char c) { return std::isdigit(c); })) {
    return choice == std::to_string(index);
  }
  const std::string wanted = lowered(choice);
  if (wanted == "cpu") return info.is_cpu;
  if (wanted == "gpu") return !info.is_cpu;
  return lowered(info.name).find(wanted) != std::string::npos;
}

// Explicit vectors pay on CPUs, whose compilers vectorise these kernels poorly; a GPU's work-items are its
// lanes.
int simdWidth(const cl::Device& device, const DeviceInfo& info) {
  if (!info.is_cpu) return 1;
  return device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>() >= 16 ? 16 : 8;
}

// More work-items a group would only leave more of them idle at the ends of rows and lists.
constexpr size_t kMostGroupItems = 64;

size_t groupSize(const cl::Device& device) {
  return powerOfTwoWithin(std::min(kMostGroupItems, device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>()));
}

void openDevice(ComputeContext::Impl& impl, const cl::Device& device, int simd_width, int group_size) {
  impl.device = device;
  impl.info = infoOf(device);
  impl.context = cl::Context(device);
  impl.queue = cl::CommandQueue(impl.context, device);
  impl.built = std::make_shared<BuiltPrograms>();
  impl.simd_width = simd_width > 0 ? simd_width : simdWidth(device, impl.info);
  impl.group_size = group_size > 0 ? group_size : groupSize(device);
}

// Runs a kernel that uses what the stages need (vectors, gathers, atomics) and compares its result.
void selfTest(ComputeContext& compute) {
  constexpr int kCount = 1024;
  std::vector<int> values(kCount);
  std::iota(values.begin(), values.end(), -kCount / 2);
  DeviceBuffer input(compute, kCount * sizeof(int), "the self-test");
  DeviceBuffer sum(compute, sizeof(int), "the self-test");
  input.write(values);
  sum.fill(0, sizeof(int));
  const int width = compute.impl().simd_width;
  Kernel(compute, "compute/self_test.cl", "sum_of_squares").run(kCount / width, input, sum, kCount / width);
  const int expected =
      std::accumulate(values.begin(), values.end(), 0, [](int s, int v) { return s + v * v; });
  const int found = sum.read<int>(1).front();
  check(found == expected,
        "the self-test gave " + std::to_string(found) + " instead of " + std::to_string(expected));
}

}  // namespace

std::vector<DeviceInfo> ComputeContext::listDevices() {
  std::vector<DeviceInfo> infos;
  for (const cl::Device& device : allDevices()) infos.push_back(infoOf(device));
  return infos;
}

ComputeContext::ComputeContext(const std::string& choice, int simd_width, int group_size)
    : impl_(std::make_unique<Impl>()) {
  check(simd_width == 0 || simd_width == 1 || simd_width == 8 || simd_width == 16,
        "the kernels are written for vectors of 1, 8 and 16, not of " + std::to_string(simd_width));
  const char* environment = std::getenv("DEPTH_FUSION_DEVICE");
  const std::string wanted = choice.empty() && environment != nullptr ? environment : choice;
  const std::vector<cl::Device> devices = allDevices();
  check(!devices.empty(),
        "no OpenCL device found; install one, as the CPU device of the package pocl-opencl-icd, and see "
        "`clinfo`");

  std::vector<size_t> order(devices.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_partition(order.begin(), order.end(), [&](size_t i) { return !infoOf(devices[i]).is_cpu; });
  std::string refused;
  for (const size_t index : order) {
    const DeviceInfo info = infoOf(devices[index]);
    const std::string label = "[" + std::to_string(index) + "] " + info.name;
    if (!matches(wanted, index, info)) {
      refused += "; " + label + " not chosen by '" + wanted + "'";
      continue;
    }
    try {
      openDevice(*impl_, devices[index], simd_width, group_size);
      selfTest(*this);
      impl_->report = label + " (" + info.platform + ", " + info.version + ", vectors of " +
                      std::to_string(impl_->simd_width) + "), self-test passed" + refused;
      return;
    } catch (const std::exception& error) {
      refused += "; " + label + " refused: " + error.what();
    }
  }
  throw Error("no usable OpenCL device" + refused + "; list them with --device list");
}

ComputeContext::ComputeContext(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

std::unique_ptr<ComputeContext> ComputeContext::anotherQueue() {
  auto other = std::make_unique<Impl>();
  other->device = impl_->device;
  other->context = impl_->context;
  other->queue = cl::CommandQueue(impl_->context, impl_->device);
  other->info = impl_->info;
  other->report = impl_->report;
  other->simd_width = impl_->simd_width;
  other->group_size = impl_->group_size;
  other->built = impl_->built;
  return std::unique_ptr<ComputeContext>(new ComputeContext(std::move(other)));
}

ComputeContext::~ComputeContext() = default;

const DeviceInfo& ComputeContext::device() const { return impl_->info; }

const std::string& ComputeContext::selfTestReport() const { return impl_->report; }

void ComputeContext::finish() {
  try {
    impl_->queue.finish();
  } catch (const cl::Error& error) {
    throw Error(std::string("OpenCL ") + error.what() + ": " + statusText(error.err()));
  }
}

}  // namespace depth_fusion
