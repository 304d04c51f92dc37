// Hierarchy of axis-aligned boxes. Private to geom/nurbs.
#pragma once

#include "Vector3.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace cadrefine
{

struct BoundingBox
{
  Point3 low{ std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
    std::numeric_limits<double>::infinity() };
  Point3 high{ -std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
    -std::numeric_limits<double>::infinity() };

  void include(const Point3& p);
  void include(const BoundingBox& box);
  bool isEmpty() const { return low[0] > high[0]; }
  double diagonal() const { return isEmpty() ? 0.0 : distance(low, high); }
  double squaredDistance(const Point3& q) const
  {
    double sum = 0;
    for (int k = 0; k < 3; ++k)
    {
      const double gap = std::max(std::max(low[k] - q[k], q[k] - high[k]), 0.0);
      sum += gap * gap;
    }
    return sum;
  }
};

/// Binary trees over items (numbers of the caller's), all in one array of nodes, so that trees over
/// parts can be joined into a tree over the whole. Build O(n log n), balanced: depth at most
/// log2(n) + 1 for each level of joining.
class BoundingBoxTree
{
public:
  /// What a tree is built over: an item, or the root of a tree built before.
  struct Entry
  {
    BoundingBox box;
    int item = -1; ///< Number of the item, or -1.
    int root = -1; ///< Root of a tree, where `item` is -1.
  };

  static constexpr int none = -1;

  /// Root of a tree over `entries`; `none` where there are none.
  int build(std::vector<Entry> entries);
  const BoundingBox& box(int root) const { return nodes_[root].box; }

  /// Calls `visit(item, squaredDistance of its box)` for every item below `root` whose box may be
  /// within the square root of `limit()` of q, nearer boxes first; `limit` is asked again after
  /// every visit.
  template<typename Limit, typename Visit>
  void visitNear(int root, const Point3& q, const Limit& limit, const Visit& visit) const;

private:
  struct Node
  {
    BoundingBox box;
    int left = none; // child, or none at an item
    int right = none;
    int item = -1;
  };

  int buildRange(std::vector<Entry>& entries, int first, int last);

  std::vector<Node> nodes_;
};

template<typename Limit, typename Visit>
void BoundingBoxTree::visitNear(
  int root, const Point3& q, const Limit& limit, const Visit& visit) const
{
  struct Waiting
  {
    int node;
    double squaredDistance;
  };
  constexpr int stackSize = 128; // more than twice the depth of a tree over 2^31 items
  Waiting stack[stackSize];
  int size = 0;
  if (root != none)
  {
    stack[size++] = { root, nodes_[root].box.squaredDistance(q) };
  }
  while (size > 0)
  {
    Waiting here = stack[--size];
    while (here.squaredDistance <= limit())
    {
      const Node& node = nodes_[here.node];
      if (node.left == none)
      {
        visit(node.item, here.squaredDistance);
        break;
      }
      Waiting far = { node.right, nodes_[node.right].box.squaredDistance(q) };
      here = { node.left, nodes_[node.left].box.squaredDistance(q) };
      if (far.squaredDistance < here.squaredDistance)
      {
        std::swap(here, far);
      }
      stack[size++] = far;
    }
  }
}

} // namespace cadrefine
