#include "store/lmdb_database.h"

#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <utility>

#include "depth_fusion/common/error.h"
#include "store/lmdb_damage.h"
#include "store/lmdb_environment.h"

namespace depth_fusion {
namespace {

namespace fs = std::filesystem;

MDB_val valueOf(const std::string& bytes) { return {bytes.size(), const_cast<char*>(bytes.data())}; }

std::string bytesOf(const MDB_val& value) { return {static_cast<const char*>(value.mv_data), value.mv_size}; }

// An open file, which may be open once in a process.
struct LmdbFile {
  std::string path;
  LmdbEnvironment environment;
  MDB_dbi rows = 0;
  std::atomic<size_t> touched_bytes{0};  // since its pages were released
};
using LmdbFilePtr = std::shared_ptr<LmdbFile>;

LmdbTransaction begin(const LmdbFile& file, unsigned flags) {
  MDB_txn* transaction = nullptr;
  checkLmdb(mdb_txn_begin(file.environment.get(), nullptr, flags, &transaction), file.path,
            (flags & MDB_RDONLY) != 0 ? "cannot be read" : "cannot be written");
  return LmdbTransaction(transaction);
}

// So much may be read or written before the file's pages are released.
constexpr size_t kTouchedBytes = size_t{16} << 20;

// Reads for either kind of transaction.
template <class Interface>
class LmdbRows : public Interface {
 public:
  LmdbRows(LmdbFilePtr file, unsigned flags) : file_(std::move(file)), transaction_(begin(*file_, flags)) {}

  std::optional<std::string> get(const std::string& key) override {
    MDB_val name = valueOf(key), value;
    const int code = mdb_get(transaction_.get(), file_->rows, &name, &value);
    if (code == MDB_NOTFOUND) return std::nullopt;
    checkLmdb(code, file_->path, "cannot be read");
    noteTouched(value.mv_size);
    return bytesOf(value);
  }

  void forEach(const std::string& prefix, const DatabaseReader::Visit& visit) override {
    MDB_cursor* opened = nullptr;
    checkLmdb(mdb_cursor_open(transaction_.get(), file_->rows, &opened), file_->path, "cannot be read");
    const LmdbCursor cursor(opened);
    MDB_val key = valueOf(prefix), value;
    int code = mdb_cursor_get(opened, &key, &value, prefix.empty() ? MDB_FIRST : MDB_SET_RANGE);
    for (; code == MDB_SUCCESS; code = mdb_cursor_get(opened, &key, &value, MDB_NEXT)) {
      const std::string name = bytesOf(key);
      if (name.compare(0, prefix.size(), prefix) != 0) return;
      noteTouched(value.mv_size);
      visit(name, bytesOf(value));
    }
    if (code != MDB_NOTFOUND) checkLmdb(code, file_->path, "cannot be read");
  }

 protected:
  // A value of so many bytes was read or written.
  void noteTouched(size_t bytes) {
    file_->touched_bytes += bytes;
    if (file_->touched_bytes < kTouchedBytes) return;
    file_->touched_bytes = 0;
    releasePages(file_->environment.get());
  }

  LmdbFilePtr file_;
  LmdbTransaction transaction_;
};

class LmdbReader final : public LmdbRows<DatabaseReader> {
 public:
  explicit LmdbReader(const LmdbFilePtr& file) : LmdbRows(file, MDB_RDONLY) {}
};

class LmdbWriter final : public LmdbRows<DatabaseWriter> {
 public:
  explicit LmdbWriter(const LmdbFilePtr& file) : LmdbRows(file, 0) {}

  void put(const std::string& key, const std::string& bytes) override {
    MDB_val name = valueOf(key), value = valueOf(bytes);
    checked(mdb_put(transaction_.get(), file_->rows, &name, &value, 0));
    noteTouched(value.mv_size);
  }
  void erase(const std::string& key) override {
    MDB_val name = valueOf(key);
    const int code = mdb_del(transaction_.get(), file_->rows, &name, nullptr);
    if (code != MDB_NOTFOUND) checked(code);
  }
  void clear() override { checked(mdb_drop(transaction_.get(), file_->rows, 0)); }
  void commit() override { checked(mdb_txn_commit(transaction_.release())); }

 private:
  void checked(int code) const { checkLmdb(code, file_->path, "cannot be written"); }
};

// Whether the open file is the one at the path: it may have been moved away, or replaced.
bool isThere(const LmdbFile& file) {
  struct stat there {};
  struct stat open {};
  int descriptor = -1;
  return mdb_env_get_fd(file.environment.get(), &descriptor) == MDB_SUCCESS &&
         fstat(descriptor, &open) == 0 && stat(file.path.c_str(), &there) == 0 &&
         there.st_dev == open.st_dev && there.st_ino == open.st_ino;
}

uint64_t fileBytes(const LmdbFile& file) {
  struct stat open {};
  int descriptor = -1;
  checkLmdb(mdb_env_get_fd(file.environment.get(), &descriptor), file.path, "cannot be looked at");
  check(fstat(descriptor, &open) == 0, file.path + " cannot be looked at");
  return static_cast<uint64_t>(open.st_size);
}

// The file and its lock file.
void removeFiles(const std::string& path) {
  std::error_code ignored;
  fs::remove(path, ignored);
  fs::remove(path + "-lock", ignored);
}

// The database of all the rows. The flags are of the transaction that opens it.
MDB_dbi openRows(const LmdbFile& file, unsigned flags) {
  const LmdbTransaction transaction = begin(file, flags);
  MDB_dbi rows = 0;
  checkLmdb(mdb_dbi_open(transaction.get(), nullptr, 0, &rows), file.path, "cannot be opened");
  return rows;
}

class LmdbDatabase final : public Database {
 public:
  LmdbDatabase(LmdbFilePtr file, DatabaseAccess access) : file_(std::move(file)), access_(access) {}

  std::unique_ptr<DatabaseReader> read() override { return std::make_unique<LmdbReader>(file_); }
  std::unique_ptr<DatabaseWriter> write() override {
    check(access_ == DatabaseAccess::kWrite, file_->path + " was opened for reading");
    return std::make_unique<LmdbWriter>(file_);
  }
  uint64_t bytes() override { return fileBytes(*file_); }
  bool isThere() const override { return depth_fusion::isThere(*file_); }
  std::string name() const override { return file_->path; }

 private:
  LmdbFilePtr file_;
  DatabaseAccess access_;
};

bool canBeWritten(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  return access(folder.c_str(), W_OK) == 0 && (!fs::exists(path) || access(path.c_str(), W_OK) == 0);
}

// Returns flags of mdb_env_open. Where no lock file can be made and none is there, nobody else has the file
// open.
unsigned openingFlags(const std::string& path) {
  if (canBeWritten(path)) return 0;
  check(!fs::exists(path + "-lock"),
        path + " is another user's, who may be writing it; copy it, and read the copy");
  return MDB_RDONLY | MDB_NOLOCK;
}

// The files that this process has open, each once. They are opened and closed under one mutex.
class OpenFiles {
 public:
  LmdbFilePtr open(const std::string& path) {
    const std::lock_guard<std::recursive_mutex> lock(mutex_);
    LmdbFilePtr file = files_[path].lock();
    if (file != nullptr && isThere(*file)) return file;
    const std::string damage = fs::exists(path) ? lmdbDamage(path) : "";
    check(damage.empty(), damage);
    file.reset(new LmdbFile, [this](LmdbFile* closed) {
      const std::lock_guard<std::recursive_mutex> closing(mutex_);
      delete closed;
    });
    const unsigned flags = openingFlags(path);
    file->path = path;
    file->environment = openEnvironment(path, flags);
    file->rows = openRows(*file, flags & MDB_RDONLY);
    files_[path] = file;
    return file;
  }

 private:
  std::recursive_mutex mutex_;
  std::map<std::string, std::weak_ptr<LmdbFile>> files_;
};

OpenFiles& openFiles() {
  static OpenFiles files;
  return files;
}

}  // namespace

void checkWritable(const std::string& path) {
  check(canBeWritten(path), path + " cannot be written; choose a place that can");
}

std::unique_ptr<Database> openLmdb(const std::string& path, DatabaseAccess access) {
  check(!fs::is_directory(path), path + " is a folder; give the name of a file");
  if (access == DatabaseAccess::kWrite) checkWritable(path);
  return std::make_unique<LmdbDatabase>(openFiles().open(fs::weakly_canonical(path).string()), access);
}

std::unique_ptr<Database> openScratch(const std::string& folder) {
  std::error_code error;
  const fs::path where = folder.empty() ? fs::temp_directory_path(error) : fs::path(folder);
  std::string path = (where / "depth_fusion_XXXXXX").string();
  const int descriptor = mkstemp(path.data());
  check(descriptor >= 0, "no file can be made in the folder " + where.string() + " (" + strerror(errno) +
                             "); give submaps/store one that can be written");
  close(descriptor);
  auto file = std::make_shared<LmdbFile>();
  file->path = path;
  try {
    file->environment = openEnvironment(path, MDB_NOSYNC);
    file->rows = openRows(*file, 0);
  } catch (...) {
    removeFiles(path);
    throw;
  }
  removeFiles(path);
  return std::make_unique<LmdbDatabase>(file, DatabaseAccess::kWrite);
}

}  // namespace depth_fusion
