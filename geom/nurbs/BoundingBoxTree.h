// Hierarchies of axis-aligned boxes. Private to geom/nurbs.
#pragma once

#include "BoundingBox.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace cadrefine
{

/// Trees over items (numbers of the caller's), all in one array of nodes. A node holds the boxes of
/// its up to four children, side by side in single precision and rounded outward, in units of
/// `size` round `centre`: two cache lines, and one pass over them for the distances to all four.
/// Build O(n log n); memory about 45 bytes an item; depth O(log n).
class BoundingBoxTree
{
public:
  struct Entry
  {
    BoundingBox box;
    int item = 0; ///< Not negative.
  };

  /// A node, or an item where there is only one.
  using Root = std::int32_t;
  static constexpr Root none = std::numeric_limits<Root>::min();

  BoundingBoxTree() = default;
  /// All boxes should lie within `size` of `centre`, or tests are less sharp.
  BoundingBoxTree(const Point3& centre, double size);

  /// A tree over `entries`, which are put into an order in which neighbours are near each other.
  Root build(std::vector<Entry>& entries);

  /// A tree over two others, each of which may be `none`. Where both are equally near, `b` is
  /// visited first.
  Root join(Root a, Root b);

  /// Calls `visit(item, bound)` for every item below `root` whose box may be within the square root
  /// of `limit()` of q, nearer boxes first; the squared distance of the box is at least `bound`.
  /// `limit` is asked again after every visit.
  template<typename Limit, typename Visit>
  void visitNear(Root root, const Point3& q, const Limit& limit, const Visit& visit) const;

private:
  static constexpr int width = 4;

  /// One number for each child, worked on at once (a vector type of GCC and Clang).
  using Lanes = float __attribute__((vector_size(width * sizeof(float))));

  struct alignas(64) Node
  {
    std::array<Lanes, 3> low, high;
    std::array<Root, width> child;
  };

  /// A point in the tree's units, between two numbers of single precision.
  struct RoundedPoint
  {
    std::array<float, 3> low, high;
  };

  static Root toRoot(int item) { return ~item; }
  static int toItem(Root root) { return ~root; }

  /// Appends a node without children.
  Root addNode();
  Root buildRange(std::vector<Entry>& entries, std::size_t first, std::size_t last);
  RoundedPoint rounded(const Point3& p) const;
  static Lanes squaredDistances(const Node& node, const RoundedPoint& q);

  std::vector<Node> nodes_;
  Point3 centre_{};
  double scale_ = 1.0;
};

inline BoundingBoxTree::RoundedPoint BoundingBoxTree::rounded(const Point3& p) const
{
  constexpr double largest = 1e15; // so that squares do not overflow; nothing of the model is there
  constexpr double up = 1.0 + 1.2e-7; // more than a step of single precision
  constexpr double down = 1.0 - 1.2e-7;
  RoundedPoint r;
  for (int k = 0; k < 3; ++k)
  {
    const double x = std::clamp(scale_ * (p[k] - centre_[k]), -largest, largest);
    r.low[k] = static_cast<float>(x * (x > 0 ? down : up));
    r.high[k] = static_cast<float>(x * (x > 0 ? up : down));
  }
  return r;
}

/// Lower bounds; infinite for children that are not there.
inline BoundingBoxTree::Lanes BoundingBoxTree::squaredDistances(
  const Node& node, const RoundedPoint& q)
{
  constexpr float rounding = 1.0F - 1e-6F;
  Lanes sum{};
  for (int k = 0; k < 3; ++k)
  {
    const Lanes below = node.low[k] - q.high[k];
    const Lanes above = q.low[k] - node.high[k];
    const Lanes larger = below > above ? below : above;
    const Lanes gap = larger > 0.0F ? larger : 0.0F;
    sum += gap * gap;
  }
  return rounding * sum;
}

template<typename Limit, typename Visit>
void BoundingBoxTree::visitNear(
  Root root, const Point3& q, const Limit& limit, const Visit& visit) const
{
  struct Waiting
  {
    Root root;
    float bound;
  };
  constexpr int stackSize = 256; // three times the depth of a tree over 2^31 items, and more
  constexpr double up = 1.0 + 1.2e-7;
  constexpr float nowhere = std::numeric_limits<float>::infinity();
  std::array<Waiting, stackSize> stack;
  const RoundedPoint at = rounded(q);
  const double unit = 1.0 / (scale_ * scale_);
  const auto reachOf = [&](double squaredLimit)
  {
    return static_cast<float>(
      std::min<double>(up * scale_ * scale_ * squaredLimit, std::numeric_limits<float>::max()));
  };
  float reach = reachOf(limit());
  int size = 0;
  Waiting next = { root, root == none ? nowhere : 0.0F };
  while (next.bound <= reach || size > 0)
  {
    const Waiting here = next.bound <= reach ? next : stack[--size];
    next.bound = nowhere;
    if (here.bound > reach)
    {
      continue;
    }
    if (here.root < 0)
    {
      visit(toItem(here.root), unit * here.bound);
      reach = reachOf(limit());
      continue;
    }
    // Without branches: the nearest child is next, others within reach go onto the stack.
    const Node& node = nodes_[here.root];
    const Lanes bounds = squaredDistances(node, at);
    for (int i = 0; i < width; ++i)
    {
      const Waiting child = { node.child[i], bounds[i] };
      const bool nearer = child.bound <= next.bound;
      const Waiting farther = nearer ? next : child;
      next = nearer ? child : next;
      stack[size] = farther;
      size += farther.bound <= reach ? 1 : 0;
    }
  }
}

} // namespace cadrefine
