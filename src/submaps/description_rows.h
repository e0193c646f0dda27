// The rows by which a map says what it is.
#pragma once

#include <string>

#include "depth_fusion/submaps/map_description.h"

namespace depth_fusion {

// Packed rows. What parses them throws Error, naming `where`, for a row of another kind or version, or a
// damaged one. The submaps have rows of their own.
std::string descriptionRow(const MapDescription& description);
MapDescription parseDescription(const std::string& row, const std::string& where);
std::string submapRow(const SubmapDescription& submap);
SubmapDescription parseSubmap(const std::string& row, const std::string& where);

}  // namespace depth_fusion
