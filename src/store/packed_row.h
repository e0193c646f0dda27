// Rows as they lie in a database: compressed, with a checksum.
#pragma once

#include <string>
#include <string_view>

namespace depth_fusion {

// The contents of a row are at most so large: whoever reads one allocates no more.
constexpr size_t kMaxRowBytes = size_t{64} << 20;

std::string packed(std::string_view contents);
// Throws Error, naming `where`, for bytes that are not a whole packed row.
std::string unpacked(std::string_view row, const std::string& where);

}  // namespace depth_fusion
