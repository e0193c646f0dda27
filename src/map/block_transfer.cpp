#include "map/block_transfer.h"

namespace depth_fusion {
namespace {

// Calls with the place in the list and the length of each run of slots in a row.
template <class Function>
void forEachRun(const std::vector<int>& slots, const Function& function) {
  for (size_t begin = 0, end = 0; begin < slots.size(); begin = end) {
    for (end = begin + 1; end < slots.size() && slots[end] == slots[end - 1] + 1;) ++end;
    function(begin, end - begin);
  }
}

}  // namespace

std::string readSlots(const DeviceBuffer& buffer, const std::vector<int>& slots, size_t bytes_per_slot) {
  std::string contents(slots.size() * bytes_per_slot, '\0');
  forEachRun(slots, [&](size_t begin, size_t count) {
    buffer.read(&contents[begin * bytes_per_slot], count * bytes_per_slot,
                static_cast<size_t>(slots[begin]) * bytes_per_slot);
  });
  return contents;
}

void writeSlots(DeviceBuffer& buffer, const std::vector<int>& slots, const std::string& contents,
                size_t bytes_per_slot) {
  forEachRun(slots, [&](size_t begin, size_t count) {
    buffer.write(&contents[begin * bytes_per_slot], count * bytes_per_slot,
                 static_cast<size_t>(slots[begin]) * bytes_per_slot);
  });
}

}  // namespace depth_fusion
