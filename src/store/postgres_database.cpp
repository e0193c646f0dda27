#include "store/postgres_database.h"

#include <map>
#include <utility>
#include <vector>

#include "depth_fusion/common/error.h"
#include "store/postgres_connection.h"

namespace depth_fusion {
namespace {

constexpr char kMakeTable[] =
    "CREATE TABLE IF NOT EXISTS depth_fusion_rows (map text NOT NULL, key bytea NOT NULL, value bytea NOT "
    "NULL, "
    "PRIMARY KEY (map, key))";
// A writer holds this row of its map, so that a second one waits.
const std::string kLockKey(1, '\0');

// The first key after all those with the prefix; empty if there is none.
std::string afterPrefix(std::string prefix) {
  while (!prefix.empty() && static_cast<unsigned char>(prefix.back()) == 0xff) prefix.pop_back();
  if (!prefix.empty()) ++prefix.back();
  return prefix;
}

bool hasTable(PostgresConnection& connection) {
  constexpr char kLook[] =
      "SELECT table_name FROM information_schema.tables WHERE table_name = 'depth_fusion_rows'";
  return connection.execute(kLook).rows() > 0;
}

// Reads for either kind of transaction.
template <class Interface>
class PostgresRows : public Interface {
 public:
  PostgresRows(const PostgresPlace& place, const std::string& begin) : map_(place.map), connection_(place) {
    connection_.execute(begin);
  }

  std::optional<std::string> get(const std::string& key) override {
    flush();
    const auto result =
        connection_.execute("SELECT value FROM depth_fusion_rows WHERE map = $1 AND key = $2", {map_, key});
    return result.rows() == 0 ? std::nullopt : std::optional<std::string>(result.bytes(0, 0));
  }

  // Page by page, each from the last key on.
  void forEach(const std::string& prefix, const DatabaseReader::Visit& visit) override {
    flush();
    const std::string end = afterPrefix(prefix);
    std::string last = prefix, compare = ">=";
    while (true) {
      std::vector<std::string> parameters = {map_, last};
      if (!end.empty()) parameters.push_back(end);
      const auto page =
          connection_.execute("SELECT key, value FROM depth_fusion_rows WHERE map = $1 AND key " + compare +
                                  " $2" + (end.empty() ? "" : " AND key < $3") + " ORDER BY key LIMIT 100",
                              parameters);
      for (int row = 0; row < page.rows(); ++row) {
        last = page.bytes(row, 0);
        if (last != kLockKey) visit(last, page.bytes(row, 1));
      }
      if (page.rows() == 0) return;
      compare = ">";
    }
  }

 protected:
  // Sends what waits to be written.
  virtual void flush() {}

  std::string map_;
  PostgresConnection connection_;
};

class PostgresReader final : public PostgresRows<DatabaseReader> {
 public:
  explicit PostgresReader(const PostgresPlace& place)
      : PostgresRows(place, "BEGIN TRANSACTION ISOLATION LEVEL REPEATABLE READ READ ONLY") {}
};

class PostgresWriter final : public PostgresRows<DatabaseWriter> {
 public:
  explicit PostgresWriter(const PostgresPlace& place) : PostgresRows(place, "BEGIN"), name_(place.name) {
    insert({{kLockKey, ""}});
  }

  void put(const std::string& key, const std::string& value) override {
    waiting_[key] = value;
    waiting_bytes_ += value.size();
    if (waiting_.size() >= kMaxWaiting || waiting_bytes_ >= kMaxWaitingBytes) flush();
  }
  void erase(const std::string& key) override {
    flush();
    connection_.execute("DELETE FROM depth_fusion_rows WHERE map = $1 AND key = $2", {map_, key});
  }
  void clear() override {
    waiting_.clear();
    connection_.execute("DELETE FROM depth_fusion_rows WHERE map = $1 AND key <> $2", {map_, kLockKey});
  }
  void commit() override {
    flush();
    // One in which a statement failed ends as a rollback, which is no error to the server.
    check(connection_.execute("COMMIT").tag() == "COMMIT", name_ + ": nothing was written");
  }

 private:
  static constexpr size_t kMaxWaiting = 64;
  static constexpr size_t kMaxWaitingBytes = size_t{4} << 20;
  using Rows = std::map<std::string, std::string>;  // a statement may name a key once

  void flush() override {
    if (!waiting_.empty()) insert(std::exchange(waiting_, {}));
    waiting_bytes_ = 0;
  }

  void insert(const Rows& rows) {
    std::vector<std::string> parameters = {map_};
    std::string places;
    for (const auto& [key, value] : rows) {
      const size_t next = parameters.size() + 1;
      places += std::string(places.empty() ? "" : ", ") + "($1, CAST($" + std::to_string(next) +
                " AS bytea), CAST($" + std::to_string(next + 1) + " AS bytea))";
      parameters.push_back(key);
      parameters.push_back(value);
    }
    connection_.execute("INSERT INTO depth_fusion_rows (map, key, value) VALUES " + places +
                            " ON CONFLICT (map, key) DO UPDATE SET value = EXCLUDED.value",
                        parameters);
  }

  std::string name_;
  Rows waiting_;
  size_t waiting_bytes_ = 0;
};

class PostgresDatabase final : public Database {
 public:
  PostgresDatabase(PostgresPlace place, DatabaseAccess access) : place_(std::move(place)), access_(access) {}

  std::unique_ptr<DatabaseReader> read() override { return std::make_unique<PostgresReader>(place_); }
  std::unique_ptr<DatabaseWriter> write() override {
    check(access_ == DatabaseAccess::kWrite, place_.name + " was opened for reading");
    return std::make_unique<PostgresWriter>(place_);
  }
  uint64_t bytes() override {
    const auto sum = PostgresConnection(place_).execute(
        "SELECT CAST(COALESCE(SUM(LENGTH(key) + LENGTH(value)), 0) AS text) FROM depth_fusion_rows WHERE map "
        "= $1",
        {place_.map});
    return std::stoull(sum.bytes(0, 0));
  }
  bool isThere() const override { return true; }
  std::string name() const override { return place_.name; }

 private:
  PostgresPlace place_;
  DatabaseAccess access_;
};

}  // namespace

std::unique_ptr<Database> makePostgres(const std::string& location) {
  const PostgresPlace place = parsePostgresPlace(location);
  PostgresConnection connection(place);
  if (!hasTable(connection)) connection.execute(kMakeTable);
  return std::make_unique<PostgresDatabase>(place, DatabaseAccess::kWrite);
}

std::unique_ptr<Database> openPostgresIfThere(const std::string& location) {
  const PostgresPlace place = parsePostgresPlace(location);
  PostgresConnection connection(place);
  if (!hasTable(connection)) return nullptr;
  const auto rows =
      connection.execute("SELECT key FROM depth_fusion_rows WHERE map = $1 LIMIT 1", {place.map});
  if (rows.rows() == 0) return nullptr;
  return std::make_unique<PostgresDatabase>(place, DatabaseAccess::kRead);
}

}  // namespace depth_fusion
