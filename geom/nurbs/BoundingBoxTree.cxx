#include "BoundingBoxTree.h"

#include <tuple>
#include <utility>

namespace cadrefine
{

void BoundingBox::include(const Point3& p)
{
  for (int k = 0; k < 3; ++k)
  {
    low[k] = std::min(low[k], p[k]);
    high[k] = std::max(high[k], p[k]);
  }
}

void BoundingBox::include(const BoundingBox& box)
{
  for (int k = 0; k < 3; ++k)
  {
    low[k] = std::min(low[k], box.low[k]);
    high[k] = std::max(high[k], box.high[k]);
  }
}

int BoundingBoxTree::build(std::vector<Entry> entries)
{
  return entries.empty() ? none : buildRange(entries, 0, static_cast<int>(entries.size()));
}

int BoundingBoxTree::buildRange(std::vector<Entry>& entries, int first, int last)
{
  if (last - first == 1)
  {
    const Entry& only = entries[first];
    if (only.item < 0)
    {
      return only.root;
    }
    nodes_.push_back({ only.box, none, none, only.item });
    return static_cast<int>(nodes_.size()) - 1;
  }
  Node node;
  BoundingBox middles;
  const auto middle = [](const Entry& e) { return 0.5 * (e.box.low + e.box.high); };
  for (int i = first; i < last; ++i)
  {
    node.box.include(entries[i].box);
    middles.include(middle(entries[i]));
  }
  const Vector3 extent = middles.high - middles.low;
  const int axis =
    static_cast<int>(std::max_element(extent.begin(), extent.end()) - extent.begin());
  const int half = first + (last - first) / 2;
  std::nth_element(entries.begin() + first, entries.begin() + half, entries.begin() + last,
    [&](const Entry& a, const Entry& b)
    {
      return std::make_tuple(middle(a)[axis], a.item, a.root) <
             std::make_tuple(middle(b)[axis], b.item, b.root);
    });
  const int index = static_cast<int>(nodes_.size());
  nodes_.push_back(node);
  const int left = buildRange(entries, first, half);
  const int right = buildRange(entries, half, last);
  nodes_[index].left = left;
  nodes_[index].right = right;
  return index;
}

} // namespace cadrefine
