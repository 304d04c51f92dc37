// Hierarchies of axis-aligned boxes. For sources of geom/ alone.
#pragma once

#include <cadrefine/base/BoundingBox.h>
#include <cadrefine/nurbs/FetchAhead.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
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

  /// A tree over two others, each of which may be `none`.
  Root join(Root a, Root b);

  /// Calls `visit(item, bound)` for every item below `root` whose box may be within the square root
  /// of `limit()` of q, nearer boxes first; the squared distance of the box is at least `bound`.
  /// `limit` is asked again after every visit. `expect(item)` is called before for items that may
  /// be visited, so that they can be fetched from memory meanwhile.
  template<typename Limit, typename Expect, typename Visit>
  void visitNear(
    Root root, const Point3& q, const Limit& limit, const Expect& expect, const Visit& visit) const;

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

  using Waiting = std::uint64_t;
  static constexpr Waiting nowhere = std::numeric_limits<Waiting>::max();

  /// What a visit has still to look at.
  struct Queue
  {
    static constexpr int mostWaiting = 256; // three times the depth of a tree over 2^31 items
    Waiting next = nowhere;
    int size = 0;
    std::array<Waiting, mostWaiting> stack;
  };

  static Waiting waiting(Root root, float bound);
  static float boundOf(Waiting waiting);
  static Root toRoot(int item) { return ~item; }
  static int toItem(Root root) { return ~root; }

  /// Appends a node without children.
  Root addNode();
  Root buildRange(std::vector<Entry>& entries, std::size_t first, std::size_t last);
  RoundedPoint rounded(const Point3& p) const;
  template<typename Expect>
  void open(const Node& node, const RoundedPoint& q, Waiting reach, Queue& queue,
    const Expect& expect) const;
  static constexpr float mostForMiddle = 1e-13F; // in units of the squared size
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

/// Squared distances of a node's children: lower bounds, and at most mostForMiddle above them, so
/// that of boxes that q lies in the one whose middle is nearest comes first; infinite for children
/// that are not there.
inline BoundingBoxTree::Lanes BoundingBoxTree::squaredDistances(
  const Node& node, const RoundedPoint& q)
{
  constexpr float rounding = 1.0F - 1e-6F;
  constexpr float farthest = 4.0F;
  Lanes sum{};
  Lanes middles{}; // squares of twice the distances to them
  for (int k = 0; k < 3; ++k)
  {
    const Lanes below = node.low[k] - q.high[k];
    const Lanes above = q.low[k] - node.high[k];
    const Lanes larger = below > above ? below : above;
    const Lanes gap = larger > 0.0F ? larger : 0.0F;
    sum += gap * gap;
    const Lanes middle = (below < farthest ? below : farthest) - above; // both may be infinite
    middles += middle * middle;
  }
  const Lanes capped = middles < farthest ? middles : farthest;
  return rounding * sum + mostForMiddle / farthest * capped;
}

/// Lower bound and root of what waits to be visited, as one number that is the larger the larger
/// the bound is.
inline BoundingBoxTree::Waiting BoundingBoxTree::waiting(Root root, float bound)
{
  std::uint32_t bits = 0; // of numbers that are not negative, in their order
  std::memcpy(&bits, &bound, sizeof(bits));
  return static_cast<Waiting>(bits) << 32 | static_cast<std::uint32_t>(root);
}

inline float BoundingBoxTree::boundOf(Waiting waiting)
{
  const auto bits = static_cast<std::uint32_t>(waiting >> 32);
  float bound = 0;
  std::memcpy(&bound, &bits, sizeof(bound));
  return bound;
}

/// Opens a node: its nearest child becomes `next`, others within reach go onto the stack. Without
/// branches, since which child it is cannot be foretold.
template<typename Expect>
void BoundingBoxTree::open(
  const Node& node, const RoundedPoint& q, Waiting reach, Queue& queue, const Expect& expect) const
{
  const Lanes bounds = squaredDistances(node, q);
  for (int i = 0; i < width; ++i)
  {
    const Waiting child = waiting(node.child[i], bounds[i]);
    if (child <= reach)
    {
      node.child[i] < 0 ? expect(toItem(node.child[i])) : fetchAhead(&nodes_[node.child[i]]);
    }
    const Waiting exchanged = (child ^ queue.next) & (Waiting{} - (child < queue.next));
    const Waiting farther = child ^ exchanged;
    queue.next ^= exchanged;
    queue.stack[queue.size] = farther;
    queue.size += farther <= reach ? 1 : 0;
  }
}

template<typename Limit, typename Expect, typename Visit>
void BoundingBoxTree::visitNear(
  Root root, const Point3& q, const Limit& limit, const Expect& expect, const Visit& visit) const
{
  const RoundedPoint at = rounded(q);
  const double unit = 1.0 / (scale_ * scale_);
  const auto reachOf = [&](double squaredLimit)
  {
    constexpr double up = 1.0 + 1.2e-7;
    return waiting(
      -1, static_cast<float>(std::min<double>(up * (scale_ * scale_ * squaredLimit + mostForMiddle),
            std::numeric_limits<float>::max())));
  };
  Waiting reach = reachOf(limit());
  Queue queue;
  queue.next = root == none ? nowhere : waiting(root, 0.0F);
  while (queue.next <= reach || queue.size > 0)
  {
    const Waiting here = queue.next <= reach ? queue.next : queue.stack[--queue.size];
    queue.next = nowhere;
    if (here > reach)
    {
      continue;
    }
    const auto hereRoot = static_cast<Root>(here);
    if (hereRoot < 0)
    {
      visit(toItem(hereRoot), unit * (boundOf(here) - mostForMiddle));
      reach = reachOf(limit());
    }
    else
    {
      open(nodes_[hereRoot], at, reach, queue, expect);
    }
  }
}

} // namespace cadrefine
