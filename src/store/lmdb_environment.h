// LMDB's handles, which end with their owners.
#pragma once

#include <lmdb.h>

#include <memory>
#include <string>

namespace depth_fusion {

// Throws Error naming the file unless LMDB's return code is 0.
void checkLmdb(int code, const std::string& path, const std::string& doing);

struct CloseEnvironment {
  void operator()(MDB_env* environment) const { mdb_env_close(environment); }
};
using LmdbEnvironment = std::unique_ptr<MDB_env, CloseEnvironment>;

struct AbortTransaction {
  void operator()(MDB_txn* transaction) const { mdb_txn_abort(transaction); }
};
using LmdbTransaction = std::unique_ptr<MDB_txn, AbortTransaction>;

struct CloseCursor {
  void operator()(MDB_cursor* cursor) const { mdb_cursor_close(cursor); }
};
using LmdbCursor = std::unique_ptr<MDB_cursor, CloseCursor>;

// Whether a file that is shorter than it says is opened: what lies beyond its end must not be touched.
enum class FileLength { kMustFit, kMayBeCut };

// Opens the file with these flags of mdb_env_open beside those that all have here.
LmdbEnvironment openEnvironment(const std::string& path, unsigned flags,
                                FileLength length = FileLength::kMustFit);

// Takes the file's pages out of the memory of the process; those that are wanted again come from the system's
// cache. Others may read meanwhile.
void releasePages(MDB_env* environment);

}  // namespace depth_fusion
