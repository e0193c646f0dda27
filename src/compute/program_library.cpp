// Builds the embedded kernels, each program once a context.
#include <set>
#include <sstream>

#include "compute/embedded_kernels.h"
#include "compute/opencl.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

// The source with each `#include "file"` replaced by that file's text, once.
std::string expandIncludes(const std::string& path, std::set<std::string>& included) {
  if (!included.insert(path).second) return "";
  static const std::string kInclude = "#include \"";
  std::istringstream source(embeddedKernelSource(path));
  std::string expanded = "#line 1 \"" + path + "\"\n";
  std::string line;
  for (int number = 1; std::getline(source, line); ++number) {
    if (line.compare(0, kInclude.size(), kInclude) == 0) {
      const std::string file = line.substr(kInclude.size(), line.rfind('"') - kInclude.size());
      expanded +=
          expandIncludes(file, included) + "#line " + std::to_string(number + 1) + " \"" + path + "\"\n";
    } else {
      expanded += line + "\n";
    }
  }
  return expanded;
}

}  // namespace

const cl::Program& ComputeContext::Impl::program(const std::string& file, const std::string& options) {
  const std::string all_options =
      "-cl-std=CL1.2 -cl-mad-enable -cl-no-signed-zeros -DSIMD_WIDTH=" + std::to_string(simd_width) + " " +
      options;
  const std::string key = file + " " + all_options;
  const std::lock_guard<std::mutex> lock(built->mutex);
  const auto known = built->programs.find(key);
  if (known != built->programs.end()) return known->second;

  std::set<std::string> included;
  cl::Program program(context, expandIncludes(file, included));
  try {
    program.build({device}, all_options.c_str());
  } catch (const cl::Error& error) {
    throw Error("OpenCL program " + file + " (" + all_options + ") does not build on " + info.name + ": " +
                statusText(error.err()) + "\n" + program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device));
  }
  return built->programs.emplace(key, std::move(program)).first->second;
}

std::string statusText(cl_int status) {
  switch (status) {
    case CL_DEVICE_NOT_AVAILABLE:
      return "CL_DEVICE_NOT_AVAILABLE";
    case CL_MEM_OBJECT_ALLOCATION_FAILURE:
      return "CL_MEM_OBJECT_ALLOCATION_FAILURE";
    case CL_OUT_OF_RESOURCES:
      return "CL_OUT_OF_RESOURCES";
    case CL_OUT_OF_HOST_MEMORY:
      return "CL_OUT_OF_HOST_MEMORY";
    case CL_BUILD_PROGRAM_FAILURE:
      return "CL_BUILD_PROGRAM_FAILURE";
    case CL_INVALID_VALUE:
      return "CL_INVALID_VALUE";
    case CL_INVALID_BUFFER_SIZE:
      return "CL_INVALID_BUFFER_SIZE";
    case CL_INVALID_KERNEL_NAME:
      return "CL_INVALID_KERNEL_NAME";
    case CL_INVALID_KERNEL_ARGS:
      return "CL_INVALID_KERNEL_ARGS";
    case CL_INVALID_ARG_SIZE:
      return "CL_INVALID_ARG_SIZE";
    case CL_INVALID_WORK_GROUP_SIZE:
      return "CL_INVALID_WORK_GROUP_SIZE";
    default:
      return "status " + std::to_string(status);
  }
}

}  // namespace depth_fusion
