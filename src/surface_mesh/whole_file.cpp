#include "surface_mesh/whole_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

bool isDevice(const std::string& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode);
}

// Follows a link to its end, so that the file is replaced and not the link.
std::string withoutLinks(const std::string& path) {
  std::error_code error;
  const std::filesystem::path target = std::filesystem::canonical(path, error);
  return error ? path : target.string();
}

}  // namespace

WholeFile::WholeFile(const std::string& path)
    : path_(path), part_path_(isDevice(path) ? "" : withoutLinks(path) + ".part") {
  open();
  if (file_ < 0) fail("cannot be created");
}

WholeFile::~WholeFile() {
  unmap();
  if (file_ < 0) return;
  close(file_);
  if (!part_path_.empty() && has_name_) unlink(part_path_.c_str());
}

void WholeFile::open() {
  if (!part_path_.empty()) {
    const std::string folder = std::filesystem::path(part_path_).parent_path().string();
    file_ = ::open(folder.empty() ? "." : folder.c_str(), O_RDWR | O_TMPFILE | O_CLOEXEC, 0666);
    if (file_ >= 0) return;
  }
  const std::string& opened = part_path_.empty() ? path_ : part_path_;
  file_ = ::open(opened.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  has_name_ = file_ >= 0;
}

void WholeFile::writeAt(uint64_t offset, const void* data, size_t bytes) {
  const char* next = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t written = pwrite(file_, next, bytes, static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("cannot be written");
    next += written;
    offset += static_cast<uint64_t>(written);
    bytes -= static_cast<size_t>(written);
  }
}

const unsigned char* WholeFile::view(size_t bytes) {
  unmap();
  void* mapped = mmap(nullptr, bytes, PROT_READ, MAP_SHARED, file_, 0);
  if (mapped == MAP_FAILED) fail("cannot be read back");
  view_ = mapped;
  view_bytes_ = bytes;
  return static_cast<const unsigned char*>(mapped);
}

void WholeFile::cutTo(uint64_t bytes) {
  if (ftruncate(file_, static_cast<off_t>(bytes)) != 0) fail("cannot be cut");
}

void WholeFile::commit() {
  unmap();
  if (part_path_.empty() ? close(std::exchange(file_, -1)) == 0 : replace()) return;
  const int reason = errno;
  if (!part_path_.empty() && has_name_) unlink(part_path_.c_str());
  errno = reason;
  fail("cannot be written");
}

// Returns whether the file stands at the path.
bool WholeFile::replace() {
  if (!has_name_) {
    // No other name can be replaced by one for a nameless file: it gets the part's for a moment.
    unlink(part_path_.c_str());
    const std::string nameless = "/proc/self/fd/" + std::to_string(file_);
    if (linkat(AT_FDCWD, nameless.c_str(), AT_FDCWD, part_path_.c_str(), AT_SYMLINK_FOLLOW) != 0)
      return false;
    has_name_ = true;
  }
  return close(std::exchange(file_, -1)) == 0 &&
         std::rename(part_path_.c_str(), withoutLinks(path_).c_str()) == 0;
}

void WholeFile::unmap() {
  if (view_ != nullptr) munmap(view_, view_bytes_);
  view_ = nullptr;
}

void WholeFile::fail(const std::string& action) const {
  throw Error("mesh file " + path_ + " " + action + ": " + std::strerror(errno));
}

}  // namespace depth_fusion
