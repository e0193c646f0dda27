// A database in a file, by LMDB.
#pragma once

#include <memory>
#include <string>

#include "depth_fusion/store/database.h"

namespace depth_fusion {

// The file has a lock file beside it, PATH-lock. Several processes may have it open, and this one several
// times. Throws Error as openDatabase does; to be read, the file is there.
std::unique_ptr<Database> openLmdb(const std::string& path, DatabaseAccess access);

// Throws Error if the file cannot be written, or made.
void checkWritable(const std::string& path);

}  // namespace depth_fusion
