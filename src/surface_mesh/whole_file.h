// A file that appears when all of it is written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace depth_fusion {

// Writes a file without a name, which commit() gives the name PATH. Without commit() nothing is left of it,
// however the process ends, and what stood at the path stays. A file system that knows no files without names
// has PATH.part meanwhile, which stays if the process is killed. Devices are written to directly. Errors name
// the path and the reason.
class WholeFile {
 public:
  // Throws Error if the file cannot be created.
  explicit WholeFile(const std::string& path);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void writeAt(uint64_t offset, const void* data, size_t bytes);
  // Maps the file's first bytes, which must have been written, into memory, where later writes show, too. The
  // pointer is valid until the next call or commit().
  const unsigned char* view(size_t bytes);
  void cutTo(uint64_t bytes);
  void commit();

 private:
  void open();
  bool replace();
  void unmap();
  [[noreturn]] void fail(const std::string& action) const;

  std::string path_;
  std::string part_path_;  // empty for a device
  bool has_name_ = false;  // PATH.part, or the device's
  int file_ = -1;
  void* view_ = nullptr;
  size_t view_bytes_ = 0;
};

}  // namespace depth_fusion
