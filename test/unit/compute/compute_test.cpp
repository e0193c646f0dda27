#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "compute/kernel.h"
#include "depth_fusion/common/error.h"
#include "depth_fusion/compute/compute_context.h"
#include "depth_fusion/compute/device_buffer.h"

namespace depth_fusion {
namespace {

// The message of the Error that the action throws; empty if it throws none.
template <class Action>
std::string errorOf(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string upperCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

TEST(ComputeContext, ListsDevicesWithTheirProperties) {
  const std::vector<DeviceInfo> devices = ComputeContext::listDevices();
  ASSERT_FALSE(devices.empty()) << "install an OpenCL device, as the package pocl-opencl-icd";
  for (const DeviceInfo& device : devices) {
    EXPECT_FALSE(device.name.empty());
    EXPECT_FALSE(device.platform.empty());
    EXPECT_TRUE(contains(device.version, "OpenCL"));
    EXPECT_GT(device.memory_bytes, size_t{1} << 20);
  }
}

TEST(ComputeContext, ReportNamesTheDeviceThatPassedTheSelfTest) {
  const ComputeContext compute;
  EXPECT_TRUE(contains(compute.selfTestReport(), compute.device().name));
  EXPECT_TRUE(contains(compute.selfTestReport(), "self-test passed"));
}

TEST(ComputeContext, ChoosesByIndexAndByAPartOfTheName) {
  const std::vector<DeviceInfo> devices = ComputeContext::listDevices();
  const std::string name = devices.front().name;
  EXPECT_EQ(ComputeContext("0").device().name, name);
  EXPECT_THROW(ComputeContext(std::to_string(devices.size())), Error);
  EXPECT_EQ(ComputeContext(upperCase(name.substr(0, 6))).device().name.substr(0, 6), name.substr(0, 6));
}

TEST(ComputeContext, ChoosesByKind) {
  const std::vector<DeviceInfo> devices = ComputeContext::listDevices();
  for (const bool cpu : {true, false}) {
    const std::string choice = cpu ? "cpu" : "gpu";
    if (std::any_of(devices.begin(), devices.end(), [cpu](const DeviceInfo& d) { return d.is_cpu == cpu; })) {
      EXPECT_EQ(ComputeContext(choice).device().is_cpu, cpu);
    } else {
      EXPECT_TRUE(
          contains(errorOf([&] { ComputeContext compute(choice); }), "not chosen by '" + choice + "'"));
    }
  }
}

TEST(ComputeContext, UnknownChoiceSaysWhyEachDeviceWasRefused) {
  const std::string message = errorOf([] { ComputeContext compute("no such device"); });
  EXPECT_TRUE(contains(message, "no usable OpenCL device"));
  for (const DeviceInfo& device : ComputeContext::listDevices()) {
    EXPECT_TRUE(contains(message, device.name + " not chosen by 'no such device'")) << message;
  }
}

TEST(ComputeContext, EnvironmentChoosesWhereTheCallerDoesNot) {
  setenv("DEPTH_FUSION_DEVICE", "no such device", 1);
  EXPECT_NE(errorOf([] { ComputeContext compute; }), "");
  EXPECT_EQ(errorOf([] { ComputeContext compute("0"); }), "");
  unsetenv("DEPTH_FUSION_DEVICE");
  EXPECT_EQ(errorOf([] { ComputeContext compute; }), "");
}

TEST(Kernel, BuildErrorCarriesTheLog) {
  ComputeContext compute;
  const std::string message =
      errorOf([&] { Kernel(compute, "map/blocks.cl", "clear_blocks", "-DBLOCK_SIZE_LOG2=undeclared_size"); });
  EXPECT_TRUE(contains(message, "map/blocks.cl")) << message;
  EXPECT_TRUE(contains(message, compute.device().name)) << message;
  EXPECT_TRUE(contains(message, "CL_BUILD_PROGRAM_FAILURE")) << message;
  EXPECT_TRUE(contains(message.substr(message.find('\n')), "undeclared_size")) << message;
}

TEST(Kernel, UnknownFileOrNameIsNamed) {
  ComputeContext compute;
  EXPECT_TRUE(contains(errorOf([&] { Kernel(compute, "map/none.cl", "clear_blocks"); }), "map/none.cl"));
  EXPECT_TRUE(
      contains(errorOf([&] { Kernel(compute, "map/blocks.cl", "no_such_kernel"); }), "no_such_kernel"));
}

TEST(DeviceBuffer, ReadsBackWhatWasWritten) {
  ComputeContext compute;
  std::vector<int> values(1000);
  std::iota(values.begin(), values.end(), 7);
  DeviceBuffer buffer(compute, values.size() * sizeof(int), "a test");
  buffer.write(values);
  EXPECT_EQ(buffer.read<int>(values.size()), values);
  EXPECT_EQ(buffer.read<int>(2, 100 * sizeof(int)), (std::vector<int>{107, 108}));
  const int patch = -1;
  buffer.write(&patch, sizeof(patch), 5 * sizeof(int));
  values[5] = patch;
  EXPECT_EQ(buffer.read<int>(values.size()), values);
}

TEST(DeviceBuffer, FillsItsBeginning) {
  ComputeContext compute;
  DeviceBuffer buffer(compute, 4 * sizeof(int), "a test");
  buffer.write(std::vector<int>{1, 2, 3, 4});
  buffer.fill(-9, 3 * sizeof(int));
  EXPECT_EQ(buffer.read<int>(4), (std::vector<int>{-9, -9, -9, 4}));
}

TEST(DeviceBuffer, MovesWithItsContents) {
  ComputeContext compute;
  DeviceBuffer buffer(compute, sizeof(int), "a test");
  buffer.write(std::vector<int>{42});
  DeviceBuffer moved = std::move(buffer);
  EXPECT_EQ(moved.bytes(), sizeof(int));
  EXPECT_EQ(moved.read<int>(1).front(), 42);
}

TEST(DeviceBuffer, FailedAllocationNamesPurposeAndSize) {
  ComputeContext compute;
  const size_t bytes = 4 * compute.device().memory_bytes;
  const std::string message = errorOf([&] { DeviceBuffer buffer(compute, bytes, "the voxels"); });
  EXPECT_TRUE(contains(message, "the voxels")) << message;
  EXPECT_TRUE(contains(message, std::to_string(bytes >> 20) + " MiB")) << message;
}

}  // namespace
}  // namespace depth_fusion
