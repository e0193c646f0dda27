// The memory that a driver writes images into: it goes out with the image as it is, and comes back when
// nobody reads it any more.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <vector>

namespace depth_fusion {

// Thread-safe. Memory is used again only when the driver and the reader have both done with it.
class FrameBuffers {
 public:
  // Gives the driver memory to write an image into.
  uint8_t* allocate(size_t size);
  // The driver has done with it.
  void release(const uint8_t* data);

  // The bytes at this address, for the reader, who may keep them; nothing if the address is not of
  // allocate().
  std::optional<std::vector<uint8_t>> take(const uint8_t* data);
  // The reader has done with them.
  void recycle(std::vector<uint8_t> bytes);

 private:
  void keepIdle(std::vector<uint8_t> bytes);

  std::mutex mutex_;
  std::set<const uint8_t*> with_driver_;
  std::map<const uint8_t*, std::vector<uint8_t>>
      unread_;  // with the driver, and not or no longer with a reader
  std::vector<std::vector<uint8_t>> idle_;
};

}  // namespace depth_fusion
