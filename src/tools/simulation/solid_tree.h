// Solids in a tree of boxes, so that of many only those are looked at that matter.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "tools/simulation/primitive.h"

namespace depth_fusion {

class SolidTree {
 public:
  explicit SolidTree(const std::vector<Primitive>& solids);

  // Calls visit(i) for each solid i whose box, and every box around it, is one for which enter(box_W) is
  // true. Solids without end come first.
  template <typename Enter, typename Visit>
  void visit(const Enter& enter, const Visit& visit) const {
    for (const int solid : endless_) visit(solid);
    if (!nodes_.empty()) visitFrom(0, enter, visit);
  }

 private:
  struct Node {
    Eigen::AlignedBox3d box_W;
    int solid = -1;   // of a leaf
    int second = -1;  // of the two children; the first one follows its parent
  };

  template <typename Enter, typename Visit>
  void visitFrom(int index, const Enter& enter, const Visit& visit) const {
    const Node& node = nodes_[index];
    if (!enter(node.box_W)) return;
    if (node.solid >= 0) {
      visit(node.solid);
    } else {
      visitFrom(index + 1, enter, visit);
      visitFrom(node.second, enter, visit);
    }
  }

  // Adds a node for the leaves [begin, end), which it puts in order, and all below it.
  int addNode(std::vector<Node>& leaves, size_t begin, size_t end);

  std::vector<Node> nodes_;
  std::vector<int> endless_;
};

}  // namespace depth_fusion
