#include "store/lmdb_damage.h"

#include <unistd.h>

#include <cstdint>
#include <set>

#include "depth_fusion/common/error.h"
#include "store/lmdb_environment.h"
#include "store/process_apart.h"

namespace depth_fusion {
namespace {

// A file opened to be read, with a cursor on its rows.
struct OpenRows {
  LmdbEnvironment environment;
  LmdbTransaction transaction;
  LmdbCursor cursor;
};

OpenRows openDamaged(const std::string& path, FileLength length) {
  // Without the lock only where there is nobody to lock out.
  const bool has_lock = access((path + "-lock").c_str(), W_OK) == 0;
  OpenRows rows;
  rows.environment = openEnvironment(path, MDB_RDONLY | (has_lock ? 0u : MDB_NOLOCK), length);
  MDB_txn* transaction = nullptr;
  checkLmdb(mdb_txn_begin(rows.environment.get(), nullptr, MDB_RDONLY, &transaction), path, "cannot be read");
  rows.transaction.reset(transaction);
  MDB_dbi table = 0;
  checkLmdb(mdb_dbi_open(transaction, nullptr, 0, &table), path, "cannot be read");
  MDB_cursor* cursor = nullptr;
  checkLmdb(mdb_cursor_open(transaction, table, &cursor), path, "cannot be read");
  rows.cursor.reset(cursor);
  return rows;
}

// Touches every page of every row.
void touchAll(const std::string& path) {
  constexpr size_t kPage = 4096;
  const OpenRows rows = openDamaged(path, FileLength::kMustFit);
  MDB_val key, value;
  volatile char last = 0;
  int code = mdb_cursor_get(rows.cursor.get(), &key, &value, MDB_FIRST);
  for (; code == MDB_SUCCESS; code = mdb_cursor_get(rows.cursor.get(), &key, &value, MDB_NEXT)) {
    const char* bytes = static_cast<const char*>(value.mv_data);
    for (size_t i = 0; i < value.mv_size; i += kPage) last = bytes[i];
    if (value.mv_size > 0) last = bytes[value.mv_size - 1];
  }
  static_cast<void>(last);
  if (code != MDB_NOTFOUND) checkLmdb(code, path, "cannot be read");
}

void sendBytes(int pipe, const MDB_val& bytes) {
  const uint64_t size = bytes.mv_size;
  check(writeAll(pipe, &size, sizeof(size)) && writeAll(pipe, bytes.mv_data, bytes.mv_size),
        "nobody reads the rows");
}

// A row whose size is out of all reason is not one.
bool receiveBytes(int pipe, std::string& bytes) {
  constexpr uint64_t kMaxBytes = uint64_t{1} << 30;
  uint64_t size = 0;
  if (!readAll(pipe, &size, sizeof(size)) || size > kMaxBytes) return false;
  bytes.resize(size);
  return readAll(pipe, bytes.data(), size);
}

bool beginsWith(const MDB_val& key, const std::string& prefix) {
  return std::string_view(static_cast<const char*>(key.mv_data), key.mv_size).substr(0, prefix.size()) ==
         prefix;
}

void sendForwards(const std::string& path, const std::string& prefix, int pipe) {
  const OpenRows rows = openDamaged(path, FileLength::kMayBeCut);
  MDB_val key{prefix.size(), const_cast<char*>(prefix.data())}, value;
  int code = mdb_cursor_get(rows.cursor.get(), &key, &value, MDB_SET_RANGE);
  for (; code == MDB_SUCCESS && beginsWith(key, prefix);
       code = mdb_cursor_get(rows.cursor.get(), &key, &value, MDB_NEXT)) {
    sendBytes(pipe, key);
    sendBytes(pipe, value);
  }
  if (code != MDB_NOTFOUND) checkLmdb(code, path, "cannot be read");
}

void sendBackwards(const std::string& path, const std::string& prefix, int pipe) {
  const OpenRows rows = openDamaged(path, FileLength::kMayBeCut);
  const std::string after = prefix + std::string(64, '\xff');
  MDB_val key{after.size(), const_cast<char*>(after.data())}, value;
  const int found = mdb_cursor_get(rows.cursor.get(), &key, &value, MDB_SET_RANGE);
  int code = mdb_cursor_get(rows.cursor.get(), &key, &value, found == MDB_SUCCESS ? MDB_PREV : MDB_LAST);
  for (; code == MDB_SUCCESS && beginsWith(key, prefix);
       code = mdb_cursor_get(rows.cursor.get(), &key, &value, MDB_PREV)) {
    sendBytes(pipe, key);
    sendBytes(pipe, value);
  }
}

}  // namespace

std::string lmdbDamage(const std::string& path) {
  std::string problem;
  const bool ended_well = runApart(
      [&](int pipe) {
        try {
          touchAll(path);
        } catch (const Error& error) {
          const std::string what = error.what();
          writeAll(pipe, what.data(), what.size());
        }
      },
      [&](int pipe) {
        for (char c = 0; readAll(pipe, &c, 1);) problem += c;
      });
  if (ended_well || !problem.empty()) return problem;
  return path + " is damaged: its pages lead nowhere; map_info --rescue saves what can be read";
}

void salvageLmdb(const std::string& path, const std::string& prefix,
                 const std::function<void(const std::string& key, const std::string& value)>& visit) {
  std::set<std::string> seen;
  const auto receive = [&](int pipe) {
    for (std::string key, value; receiveBytes(pipe, key) && receiveBytes(pipe, value);) {
      if (seen.insert(key).second) visit(key, value);
    }
  };
  if (runApart([&](int pipe) { sendForwards(path, prefix, pipe); }, receive)) return;
  runApart([&](int pipe) { sendBackwards(path, prefix, pipe); }, receive);
}

}  // namespace depth_fusion
