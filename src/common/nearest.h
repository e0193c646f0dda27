// The nearest of some items.
#pragma once

namespace depth_fusion {

// The first of the items with the smallest gap(item), or null if every gap is larger than max_gap.
template <class Items, class Gap>
const typename Items::value_type* nearest(const Items& items, double max_gap, const Gap& gap) {
  const typename Items::value_type* found = nullptr;
  double smallest = max_gap;
  for (const typename Items::value_type& item : items) {
    const double item_gap = gap(item);
    if (item_gap > smallest || (found != nullptr && item_gap == smallest)) continue;
    found = &item;
    smallest = item_gap;
  }
  return found;
}

}  // namespace depth_fusion
