#include "tools/simulation/solid_tree.h"

#include <algorithm>

namespace depth_fusion {

SolidTree::SolidTree(const std::vector<Primitive>& solids) {
  std::vector<Node> leaves;
  for (size_t i = 0; i < solids.size(); ++i) {
    const Eigen::AlignedBox3d box_W = solids[i].boundingBox_W();
    if (box_W.sizes().allFinite()) {
      leaves.push_back({box_W, static_cast<int>(i)});
    } else {
      endless_.push_back(static_cast<int>(i));
    }
  }
  nodes_.reserve(2 * leaves.size());
  if (!leaves.empty()) addNode(leaves, 0, leaves.size());
}

int SolidTree::addNode(std::vector<Node>& leaves, size_t begin, size_t end) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.push_back(leaves[begin]);
  if (end - begin == 1) return index;

  Eigen::AlignedBox3d box_W, centres_W;
  for (size_t i = begin; i < end; ++i) {
    box_W.extend(leaves[i].box_W);
    centres_W.extend(leaves[i].box_W.center());
  }
  Eigen::Index axis = 0;
  centres_W.sizes().maxCoeff(&axis);
  const size_t middle = (begin + end) / 2;
  std::nth_element(
      leaves.begin() + begin, leaves.begin() + middle, leaves.begin() + end,
      [axis](const Node& a, const Node& b) { return a.box_W.center()[axis] < b.box_W.center()[axis]; });
  addNode(leaves, begin, middle);
  const int second = addNode(leaves, middle, end);
  nodes_[index] = {box_W, -1, second};
  return index;
}

}  // namespace depth_fusion
