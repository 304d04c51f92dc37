// Top down: a range is halved twice for the four children of a node. The cut is that, of some
// planes across the longest axis, for which the children's boxes are smallest (surface area
// heuristic, after I. Wald, "On fast construction of SAH-based bounding volume hierarchies", IEEE
// Symposium on Interactive Ray Tracing 2007), as long as it leaves an eighth on either side.

#include <cadrefine/nurbs/BoundingBoxTree.h>

#include <algorithm>
#include <tuple>

namespace cadrefine
{
namespace
{

using Entries = std::vector<BoundingBoxTree::Entry>;

constexpr int binCount = 16;

struct Bin
{
  BoundingBox box;
  std::size_t count = 0;
};

double area(const BoundingBox& box)
{
  const Vector3 d = box.high - box.low;
  return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
}

int longestAxis(const BoundingBox& box)
{
  const Vector3 extent = box.high - box.low;
  return static_cast<int>(std::max_element(extent.begin(), extent.end()) - extent.begin());
}

/// Where to cut between two bins: the number of entries before the best place. Zero: nowhere. An
/// empty bin makes all cuts beyond it too expensive.
std::size_t bestCut(const std::array<Bin, binCount>& bins, std::size_t total)
{
  std::array<double, binCount> costAfter{};
  Bin after;
  for (int i = binCount - 1; i > 0; --i)
  {
    after.box.include(bins[i].box);
    after.count += bins[i].count;
    costAfter[i] = after.count > 0 ? area(after.box) * static_cast<double>(after.count) : 0.0;
  }
  Bin before;
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 1; i < binCount; ++i)
  {
    before.box.include(bins[i - 1].box);
    before.count += bins[i - 1].count;
    if (8 * before.count < total || 8 * (total - before.count) < total || before.count == 0)
    {
      continue;
    }
    const double cost = area(before.box) * static_cast<double>(before.count) + costAfter[i];
    if (cost < least)
    {
      least = cost;
      best = before.count;
    }
  }
  return best;
}

/// Orders [first, last) so that those before the place returned go to one child.
std::size_t partition(Entries& entries, std::size_t first, std::size_t last)
{
  BoundingBox middles;
  for (std::size_t i = first; i < last; ++i)
  {
    middles.include(entries[i].box.middle());
  }
  const int axis = longestAxis(middles);
  const double low = middles.low[axis];
  const double extent = middles.high[axis] - low;
  std::array<Bin, binCount> bins;
  for (std::size_t i = first; i < last && extent > 0; ++i)
  {
    const double share = (entries[i].box.middle()[axis] - low) / extent;
    Bin& bin = bins[std::min(static_cast<int>(share * binCount), binCount - 1)];
    bin.box.include(entries[i].box);
    ++bin.count;
  }
  const std::size_t cut = bestCut(bins, last - first);
  const std::size_t place = first + (cut > 0 ? cut : (last - first) / 2);
  const auto key = [&](const BoundingBoxTree::Entry& e)
  { return std::make_tuple(e.box.middle()[axis], e.item); };
  std::nth_element(entries.begin() + first, entries.begin() + place, entries.begin() + last,
    [&](const auto& a, const auto& b) { return key(a) < key(b); });
  return place;
}

} // namespace

BoundingBoxTree::BoundingBoxTree(const Point3& centre, double size)
  : centre_(centre), scale_(size > 0 && std::isfinite(1.0 / size) ? 1.0 / size : 1.0)
{
}

BoundingBoxTree::Root BoundingBoxTree::addNode()
{
  constexpr float infinity = std::numeric_limits<float>::infinity();
  Node node;
  node.low.fill(Lanes{} + infinity);
  node.high.fill(Lanes{} - infinity);
  node.child.fill(none);
  nodes_.push_back(node);
  return static_cast<Root>(nodes_.size()) - 1;
}

BoundingBoxTree::Root BoundingBoxTree::join(Root a, Root b)
{
  if (a == none || b == none)
  {
    return a == none ? b : a;
  }
  const Root index = addNode();
  for (int c = 0; c < 2; ++c)
  {
    const Root root = c == 0 ? a : b;
    nodes_[index].child[c] = root;
    for (int k = 0; k < 3; ++k)
    {
      // The box of an item is not kept: it is visited in any case.
      float low = -std::numeric_limits<float>::max();
      float high = std::numeric_limits<float>::max();
      if (root >= 0)
      {
        const Lanes lows = nodes_[root].low[k];
        const Lanes highs = nodes_[root].high[k];
        low = std::min(std::min(lows[0], lows[1]), std::min(lows[2], lows[3]));
        high = std::max(std::max(highs[0], highs[1]), std::max(highs[2], highs[3]));
      }
      nodes_[index].low[k][c] = low;
      nodes_[index].high[k][c] = high;
    }
  }
  return index;
}

BoundingBoxTree::Root BoundingBoxTree::build(std::vector<Entry>& entries)
{
  return entries.empty() ? none : buildRange(entries, 0, entries.size());
}

BoundingBoxTree::Root BoundingBoxTree::buildRange(
  std::vector<Entry>& entries, std::size_t first, std::size_t last)
{
  if (last - first == 1)
  {
    return toRoot(entries[first].item);
  }
  std::vector<std::size_t> cuts = { first, last };
  while (cuts.size() <= width && last - first >= cuts.size())
  {
    std::size_t largest = 1;
    for (std::size_t i = 2; i < cuts.size(); ++i)
    {
      largest = cuts[i] - cuts[i - 1] > cuts[largest] - cuts[largest - 1] ? i : largest;
    }
    cuts.insert(cuts.begin() + largest, partition(entries, cuts[largest - 1], cuts[largest]));
  }
  const Root index = addNode();
  for (std::size_t c = 1; c < cuts.size(); ++c)
  {
    BoundingBox box;
    for (std::size_t i = cuts[c - 1]; i < cuts[c]; ++i)
    {
      box.include(entries[i].box);
    }
    const RoundedPoint low = rounded(box.low);
    const RoundedPoint high = rounded(box.high);
    const Root child = buildRange(entries, cuts[c - 1], cuts[c]);
    Node& node = nodes_[index];
    node.child[c - 1] = child;
    for (int k = 0; k < 3; ++k)
    {
      node.low[k][c - 1] = low.low[k];
      node.high[k][c - 1] = high.high[k];
    }
  }
  return index;
}

} // namespace cadrefine
