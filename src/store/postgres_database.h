// A database on a server of PostgreSQL's protocol, by libpq.
#pragma once

#include <memory>
#include <string>

#include "depth_fusion/store/database.h"

namespace depth_fusion {

// The rows of all maps lie in the table depth_fusion_rows, which is made where it is missing. Plain SQL only,
// so that distributed engines of that protocol serve, too. Each reader and writer has a connection of its
// own. Both throw Error as openDatabase does.
//
// To be written.
std::unique_ptr<Database> makePostgres(const std::string& location);
// To be read; null if there is no row of that map.
std::unique_ptr<Database> openPostgresIfThere(const std::string& location);

}  // namespace depth_fusion
