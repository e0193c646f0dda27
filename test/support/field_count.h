// How many members an aggregate has.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

namespace depth_fusion {

namespace field_count_detail {

// It converts to any member's type; it is never evaluated.
struct AnyValue {
  template <class Member>
  operator Member() const;
};

template <size_t>
using AnyOf = AnyValue;

template <class Aggregate, size_t... I>
auto takes(std::index_sequence<I...>) -> decltype(Aggregate{AnyOf<I>()...}, std::true_type());
template <class Aggregate, size_t... I>
std::false_type takes(...);

template <class Aggregate, size_t count, size_t... I>
constexpr bool takesValues(std::index_sequence<I...> indices) {
  return decltype(takes<Aggregate, I...>(indices))::value;
}

}  // namespace field_count_detail

// An aggregate takes as many initialisers as it has members, and not one more.
template <class Aggregate, size_t count = 0>
constexpr size_t fieldCount() {
  if constexpr (field_count_detail::takesValues<Aggregate, count + 1>(
                    std::make_index_sequence<count + 1>())) {
    return fieldCount<Aggregate, count + 1>();
  } else {
    return count;
  }
}

}  // namespace depth_fusion
