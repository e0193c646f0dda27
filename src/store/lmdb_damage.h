// Damage of LMDB files, which LMDB itself meets with a signal rather than with an error: such a file is read
// in a process of its own, which may die of it.
#pragma once

#include <functional>
#include <string>

namespace depth_fusion {

// What is wrong with the file; empty if it can be read to its end.
std::string lmdbDamage(const std::string& path);

// Calls with the rows whose keys begin with the prefix, as far as they can be reached: from the first on, and
// where that way ends, from the last one back. Each comes once, in no order.
void salvageLmdb(const std::string& path, const std::string& prefix,
                 const std::function<void(const std::string& key, const std::string& value)>& visit);

}  // namespace depth_fusion
