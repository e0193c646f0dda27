#include <filesystem>

#include "depth_fusion/common/error.h"
#include "depth_fusion/store/database.h"
#include "store/lmdb_database.h"
#include "store/postgres_connection.h"
#include "store/postgres_database.h"

namespace depth_fusion {

bool isOnServer(const std::string& location) {
  return location.rfind("postgresql://", 0) == 0 || location.rfind("postgres://", 0) == 0;
}

std::string placeName(const std::string& location) {
  return isOnServer(location) ? parsePostgresPlace(location).name : location;
}

std::unique_ptr<Database> openIfThere(const std::string& location) {
  check(!location.empty(), "no place of a map was given");
  if (isOnServer(location)) return openPostgresIfThere(location);
  std::error_code ignored;
  return std::filesystem::exists(location, ignored) ? openLmdb(location, DatabaseAccess::kRead) : nullptr;
}

std::unique_ptr<Database> openDatabase(const std::string& location, DatabaseAccess access) {
  if (access == DatabaseAccess::kRead) {
    std::unique_ptr<Database> database = openIfThere(location);
    check(database != nullptr, "there is no map " + placeName(location));
    return database;
  }
  check(!location.empty(), "no place of a map was given");
  return isOnServer(location) ? makePostgres(location) : openLmdb(location, access);
}

void checkPlace(const std::string& location) {
  std::error_code ignored;
  if (isOnServer(location) || std::filesystem::exists(location, ignored)) {
    openDatabase(location, DatabaseAccess::kWrite);
  } else {
    checkWritable(location);
  }
}

}  // namespace depth_fusion
