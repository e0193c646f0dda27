// Host and device must lay out the kernels' argument structs alike.
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "compute/embedded_kernels.h"
#include "compute/kernel.h"
#include "esdf/types.h"
#include "shared/types.h"
#include "shared/types_layout.h"

namespace depth_fusion {
namespace {

struct Entry {
  std::string name;
  int value;
};

std::vector<Entry> hostLayout() {
  std::vector<Entry> layout;
#define ADD_STRUCT(type) layout.push_back({"size of " #type, static_cast<int>(sizeof(type))});
#define ADD_MEMBER(type, member)                                                                 \
  layout.push_back({"offset of " #type "::" #member, static_cast<int>(offsetof(type, member))}); \
  layout.push_back({"size of " #type "::" #member, static_cast<int>(sizeof(type::member))});
  FOR_EACH_SHARED_TYPE(ADD_STRUCT, ADD_MEMBER)
#undef ADD_STRUCT
#undef ADD_MEMBER
  return layout;
}

TEST(SharedTypes, DeviceLaysThemOutAsTheHost) {
  const std::vector<Entry> host = hostLayout();
  ComputeContext compute;
  DeviceBuffer buffer(compute, host.size() * sizeof(int), "the layout");
  Kernel(compute, "compute/shared_types.cl", "report_layout").run(1, buffer);
  const std::vector<int> device = buffer.read<int>(host.size());
  for (size_t i = 0; i < host.size(); ++i) EXPECT_EQ(device[i], host[i].value) << host[i].name;
}

// Without padding, the members' sizes add up to the struct's; so they do not if the list lacks a member.
TEST(SharedTypes, ListHasEveryMember) {
  int members = 0;
  int structs = 0;
#define ADD_STRUCT(type) structs += static_cast<int>(sizeof(type));
#define ADD_MEMBER(type, member) members += static_cast<int>(sizeof(type::member));
  FOR_EACH_SHARED_TYPE(ADD_STRUCT, ADD_MEMBER)
#undef ADD_STRUCT
#undef ADD_MEMBER
  EXPECT_EQ(members, structs);
}

TEST(SharedTypes, ListHasEveryStruct) {
  int listed = 0;
#define ADD_STRUCT(type) ++listed;
#define IGNORE_MEMBER(type, member)
  FOR_EACH_SHARED_TYPE(ADD_STRUCT, IGNORE_MEMBER)
#undef ADD_STRUCT
#undef IGNORE_MEMBER
  const std::string source = embeddedKernelSource("shared/types.h") + embeddedKernelSource("esdf/types.h");
  int declared = 0;
  const std::string keyword = "typedef struct";
  for (size_t at = source.find(keyword); at != std::string::npos; at = source.find(keyword, at + 1))
    ++declared;
  EXPECT_EQ(listed, declared) << "kernels/shared/types_layout.h lacks a struct of types.h";
}

}  // namespace
}  // namespace depth_fusion
