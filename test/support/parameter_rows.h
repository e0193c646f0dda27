// Every member of a struct of parameters has a row of its own.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <set>
#include <string>
#include <variant>

#include "depth_fusion/common/parameters.h"
#include "support/field_count.h"

namespace depth_fusion {

// The rows, each bound to another part of the struct, are as many as the members; they have names and help,
// and the values that the struct begins with are within their ranges.
template <class Parameters>
void expectRows(size_t members = fieldCount<Parameters>()) {
  Parameters parameters;
  const auto* begin = reinterpret_cast<const char*>(&parameters);
  const ParameterTable table = parameters.table();
  std::set<const char*> places;
  std::set<std::string> names;
  for (const Parameter& row : table) {
    const auto* place =
        std::visit([](const auto* value) { return reinterpret_cast<const char*>(value); }, row.value);
    EXPECT_TRUE(place >= begin && place < begin + sizeof(parameters)) << row.name;
    EXPECT_TRUE(places.insert(place).second) << "two rows of one member: " << row.name;
    EXPECT_TRUE(names.insert(row.name).second) << "two rows of one name: " << row.name;
    EXPECT_GT(row.help.size(), 10u) << row.name;
  }
  EXPECT_EQ(table.size(), members) << "a member has no row; the rows end with " << table.back().name;
  EXPECT_NO_THROW(validate(table));
}

}  // namespace depth_fusion
