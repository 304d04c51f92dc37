#include <cadrefine/mesh/QuadTable.h>

#include <cadrefine/base/LargeMemory.h>
#include <cadrefine/base/PieceLimit.h>
#include <cadrefine/base/VertexBuckets.h>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace cadrefine
{
namespace
{

/// The edges of a quadrilateral, given in turn, in the order in which the table has them.
std::array<Index, 4> inOrder(const std::array<Index, 4>& edges)
{
  const auto smallest = std::min_element(edges.begin(), edges.end()) - edges.begin();
  const auto at = [&](std::ptrdiff_t step) { return edges[(smallest + step) % 4]; };
  return at(1) < at(3) ? std::array<Index, 4>{ at(0), at(1), at(2), at(3) }
                       : std::array<Index, 4>{ at(0), at(3), at(2), at(1) };
}

/// A key that tells quadrilaterals apart: only two opposite edges count, as no two quadrilaterals
/// share both.
std::uint64_t keyOf(const std::array<Index, 4>& ordered)
{
  return static_cast<std::uint64_t>(ordered[0]) << 32 | static_cast<std::uint64_t>(ordered[2]);
}

/// A quadrilateral of a cell.
struct CellQuad
{
  std::array<Index, 4> edges; ///< As the table has them.
  Index* number;              ///< Where the number of the quadrilateral is to stand.
};

/// Calls use(quad) for the quadrilaterals of all cells in turn.
template<class Shape, class Use>
void forQuadsOf(Shape shape, const EdgeTable& table, QuadTable& quads, const Use& use)
{
  const auto& edgesOf = table.*edgesOfCells(shape);
  auto& numbers = quads.*quadsOfCells(shape);
  for (std::size_t c = 0; c < numbers.size(); ++c)
  {
    for (std::size_t q = 0; q < numbers[c].size(); ++q)
    {
      const auto& [i, j, k, l] = Shape::quadEdges[q];
      const auto& edges = edgesOf[c];
      use({ inOrder({ edges[i], edges[j], edges[k], edges[l] }), &numbers[c][q] });
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

/// Makes room for the numbers of the quadrilaterals of each cell, and returns how many there are.
std::size_t resizeNumbers(const EdgeTable& table, QuadTable& quads)
{
  resizeLong(quads.ofPyramids, table.ofPyramids.size());
  resizeLong(quads.ofWedges, table.ofWedges.size());
  resizeLong(quads.ofHexahedra, table.ofHexahedra.size());
  resizeLong(quads.ofQuadrilaterals, table.ofQuadrilaterals.size());
  return quads.ofPyramids.size() + 3 * quads.ofWedges.size() + 6 * quads.ofHexahedra.size() +
         quads.ofQuadrilaterals.size();
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
  const std::size_t count = resizeNumbers(table, quads);
  requireAtMost(count, "quadrilaterals of cells", std::numeric_limits<std::uint32_t>::max());
  VertexBuckets<CellQuad> buckets(table.edges.size(), [&](const auto& use)
    { forQuads(table, quads, [&](const CellQuad& quad) { use(quad.edges[0], quad); }); });
  reserveLong(quads.edges, (count + table.ofQuadrilaterals.size()) / 2);
  buckets.forEach(
    [&](Index, CellQuad* first, CellQuad* last)
    {
      std::sort(
        first, last, [](const CellQuad& a, const CellQuad& b) { return a.edges[2] < b.edges[2]; });
      for (const CellQuad* quad = first; quad != last; ++quad)
      {
        if (quad == first || quad->edges[2] != quad[-1].edges[2])
        {
          quads.edges.push_back(quad->edges);
        }
        *quad->number = static_cast<Index>(quads.edges.size() - 1);
      }
    });
  return quads;
}

} // namespace cadrefine
