#include "store/lmdb_environment.h"

#include <sys/mman.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <fstream>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

// A file is given so much address space at most; systems that have little of it give less. The file itself is
// as large as its contents.
constexpr size_t kMostBytes = size_t{1} << 36, kLeastBytes = size_t{1} << 30;
constexpr unsigned kFlags = MDB_NOSUBDIR | MDB_NOTLS;

std::string cure(int code) {
  switch (code) {
    case ENOSPC:
    case MDB_MAP_FULL:
      return "; make room there: what was stored before is still there";
    case EACCES:
    case EROFS:
      return "; choose a place that can be written";
    case ENOENT:
      return "; does its folder exist?";
    case MDB_INVALID:
    case MDB_CORRUPTED:
    case MDB_PAGE_NOTFOUND:
      return "; it is no map file, or a damaged one";
    default:
      return "";
  }
}

void checkLength(MDB_env* environment, const std::string& path) {
  MDB_envinfo info;
  MDB_stat pages;
  checkLmdb(mdb_env_info(environment, &info), path, "cannot be looked at");
  checkLmdb(mdb_env_stat(environment, &pages), path, "cannot be looked at");
  struct stat file {};
  check(stat(path.c_str(), &file) == 0, path + " cannot be looked at");
  const size_t expected = (info.me_last_pgno + 1) * pages.ms_psize;
  check(file.st_size == 0 || static_cast<size_t>(file.st_size) >= expected,
        path + " was cut off: it has " + std::to_string(file.st_size) + " of its " +
            std::to_string(expected) + " bytes");
}

}  // namespace

void checkLmdb(int code, const std::string& path, const std::string& doing) {
  check(code == MDB_SUCCESS, path + " " + doing + ": " + mdb_strerror(code) + cure(code));
}

LmdbEnvironment openEnvironment(const std::string& path, unsigned flags, FileLength length) {
  for (size_t bytes = kMostBytes;; bytes /= 2) {
    MDB_env* created = nullptr;
    checkLmdb(mdb_env_create(&created), path, "cannot be opened");
    LmdbEnvironment environment(created);
    checkLmdb(mdb_env_set_mapsize(created, bytes), path, "cannot be opened");
    const int code = mdb_env_open(created, path.c_str(), kFlags | flags, 0644);
    if (code == ENOMEM && bytes > kLeastBytes) continue;
    checkLmdb(code, path, "cannot be opened");
    if (length == FileLength::kMustFit) checkLength(created, path);
    return environment;
  }
}

void releasePages(MDB_env* environment) {
  int descriptor = -1;
  struct stat file {};
  if (mdb_env_get_fd(environment, &descriptor) != MDB_SUCCESS || fstat(descriptor, &file) != 0) return;
  // LMDB does not tell where it has mapped the file.
  std::ifstream mappings("/proc/self/maps");
  for (std::string line; std::getline(mappings, line);) {
    void *begin = nullptr, *end = nullptr;
    size_t inode = 0;
    const int found = std::sscanf(line.c_str(), "%p-%p %*s %*s %*s %zu", &begin, &end, &inode);
    if (found != 3 || inode != file.st_ino) continue;
    const auto bytes = static_cast<char*>(end) - static_cast<char*>(begin);
    madvise(begin, static_cast<size_t>(bytes), MADV_DONTNEED);
  }
}

}  // namespace depth_fusion
