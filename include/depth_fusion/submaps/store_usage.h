// What is kept of a map outside of its pool.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace depth_fusion {

struct StoreUsage {
  size_t groups_in_memory = 0;
  size_t memory_bytes = 0;
  size_t groups_on_disk = 0;
  size_t disk_bytes = 0;
  size_t waiting_bytes = 0;      // in memory, to be compressed
  uint64_t blocks_put = 0;       // since the start
  uint64_t blocks_taken = 0;     // the same, brought back
  uint64_t bytes_packed = 0;     // the same, before compression
  uint64_t bytes_of_packed = 0;  // and after it
  double packing_s = 0.0;        // that took so long
  std::string problem;           // empty: all is well
};

}  // namespace depth_fusion
