#include <cadrefine/mesh/QuadTable.h>

#include <cadrefine/base/PieceLimit.h>
#include <cadrefine/base/RadixOrder.h>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace cadrefine
{
namespace
{

/// As the table has them, given them in turn.
std::array<Index, 4> inOrder(const std::array<Index, 4>& edges)
{
  const auto smallest = std::min_element(edges.begin(), edges.end()) - edges.begin();
  const auto at = [&](std::ptrdiff_t step) { return edges[(smallest + step) % 4]; };
  return at(1) < at(3) ? std::array<Index, 4>{ at(0), at(1), at(2), at(3) }
                       : std::array<Index, 4>{ at(0), at(3), at(2), at(1) };
}

/// Only the two opposite edges count: no two quadrilaterals share both.
std::uint64_t keyOf(const std::array<Index, 4>& ordered)
{
  return static_cast<std::uint64_t>(ordered[0]) << 32 | static_cast<std::uint64_t>(ordered[2]);
}

/// Calls use(edges, number) for the quadrilaterals of all cells in turn, `number` being where
/// theirs is to stand.
template<class Shape, class Use>
void forQuadsOf(Shape shape, const EdgeTable& table, QuadTable& quads, const Use& use)
{
  const auto& edgesOf = table.*edgesOfCells(shape);
  auto& numbers = quads.*quadsOfCells(shape);
  numbers.resize(edgesOf.size());
  for (std::size_t c = 0; c < edgesOf.size(); ++c)
  {
    for (std::size_t q = 0; q < numbers[c].size(); ++q)
    {
      std::array<Index, 4> edges;
      std::transform(std::begin(Shape::quadEdges[q]), std::end(Shape::quadEdges[q]), edges.begin(),
        [&](int edge) { return edgesOf[c][edge]; });
      use(edges, numbers[c][q]);
    }
  }
}

template<class Use>
void forQuads(const EdgeTable& table, QuadTable& quads, const Use& use)
{
  forQuadsOf(shapes::Pyramid{}, table, quads, use);
  forQuadsOf(shapes::Wedge{}, table, quads, use);
  forQuadsOf(shapes::Hexahedron{}, table, quads, use);
  forQuadsOf(shapes::Quadrilateral{}, table, quads, use);
}

} // namespace

Index QuadTable::find(const std::array<Index, 4>& itsEdges) const
{
  const auto ordered = inOrder(itsEdges);
  const auto found = std::lower_bound(edges.begin(), edges.end(), ordered,
    [](const auto& a, const auto& b) { return keyOf(a) < keyOf(b); });
  return found != edges.end() && *found == ordered ? static_cast<Index>(found - edges.begin()) : -1;
}

QuadTable buildQuadTable(const EdgeTable& table)
{
  QuadTable quads;
  std::vector<PlacedKey> keys;
  std::vector<std::array<Index, 4>> edgesOf;
  std::vector<Index*> numbers;
  forQuads(table, quads,
    [&](const std::array<Index, 4>& edges, Index& number)
    {
      edgesOf.push_back(inOrder(edges));
      keys.push_back({ keyOf(edgesOf.back()), static_cast<std::uint32_t>(numbers.size()) });
      numbers.push_back(&number);
    });
  requireAtMost(
    numbers.size(), "quadrilaterals of cells", std::numeric_limits<std::uint32_t>::max());
  radixSort(keys);
  for (std::size_t k = 0; k < keys.size(); ++k)
  {
    if (k == 0 || keys[k].key != keys[k - 1].key)
    {
      quads.edges.push_back(edgesOf[keys[k].place]);
    }
    *numbers[keys[k].place] = static_cast<Index>(quads.edges.size() - 1);
  }
  return quads;
}

} // namespace cadrefine
