// A database on a server of PostgreSQL's protocol, by libpq.
#pragma once

#include <memory>
#include <string>

#include "depth_fusion/store/database.h"

namespace depth_fusion {

// The rows of all maps lie in the table depth_fusion_rows, which is made where it is missing. Plain SQL only,
// so that distributed engines of that protocol serve, too. Each reader and writer has a connection of its
// own. Throws Error as openDatabase does.
std::unique_ptr<Database> openPostgres(const std::string& uri, DatabaseAccess access);

}  // namespace depth_fusion
