#include <filesystem>

#include "depth_fusion/common/error.h"
#include "depth_fusion/store/database.h"
#include "store/lmdb_database.h"
#include "store/postgres_database.h"

namespace depth_fusion {

bool isOnServer(const std::string& location) {
  return location.rfind("postgresql://", 0) == 0 || location.rfind("postgres://", 0) == 0;
}

std::unique_ptr<Database> openDatabase(const std::string& location, DatabaseAccess access) {
  check(!location.empty(), "no place of a map was given");
  return isOnServer(location) ? openPostgres(location, access) : openLmdb(location, access);
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
