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

// The rows are bound to parts of the struct, and none to the same as another.
template <class Parameters>
void expectWithin(const Parameters& parameters, const ParameterTable& table) {
  const auto* begin = reinterpret_cast<const char*>(&parameters);
  std::set<const char*> places;
  for (const Parameter& row : table) {
    const auto* place =
        std::visit([](const auto* value) { return reinterpret_cast<const char*>(value); }, row.value);
    EXPECT_TRUE(place >= begin && place < begin + sizeof(parameters)) << row.name;
    EXPECT_TRUE(places.insert(place).second) << "two rows of one member: " << row.name;
  }
}

// The rows, each bound to another part of the struct, are as many as the members; they have names and help,
// and the values that the struct begins with are within their ranges.
template <class Parameters>
void expectRows(size_t members = fieldCount<Parameters>()) {
  Parameters parameters;
  const ParameterTable table = parameters.table();
  expectWithin(parameters, table);
  std::set<std::string> names;
  for (const Parameter& row : table) {
    EXPECT_TRUE(names.insert(row.name).second) << "two rows of one name: " << row.name;
    EXPECT_GT(row.help.size(), 10u) << row.name;
  }
  EXPECT_EQ(table.size(), members) << "a member has no row; the rows end with " << table.back().name;
  EXPECT_NO_THROW(validate(table));
}

}  // namespace depth_fusion
