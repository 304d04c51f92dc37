#include <cadrefine/motion/CellStacks.h>

#include <algorithm>
#include <iterator>

namespace cadrefine
{
namespace
{

template<class Shape>
constexpr bool standsOnAnother(Shape)
{
  return !isSimplex(Shape{}) && Shape::corners != shapes::Pyramid::corners;
}

/// Calls visit(shape, corners) for the cell of this number, if cells of its shape stand on others.
template<class Visit>
void visitCell(const Mesh& mesh, Index cell, const Visit& visit)
{
  visitOwnCell(mesh, cell,
    [&](auto shape, const auto& corners)
    {
      if (standsOnAnother(shape))
      {
        visit(shape, corners);
      }
    });
}

template<class Corners>
bool has(const Corners& corners, Index vertex)
{
  return std::find(std::begin(corners), std::end(corners), vertex) != std::end(corners);
}

/// The end of the one edge of a cell at a vertex that leaves a side; -1: none.
template<class Shape, class Corners>
Index leaving(Shape, const Corners& corners, const Facet& side, Index vertex)
{
  for (const auto& [i, k] : Shape::edges)
  {
    const Index other = corners[i] == vertex ? corners[k] : corners[k] == vertex ? corners[i] : -1;
    if (other >= 0 && !has(side, other))
    {
      return other;
    }
  }
  return -1;
}

} // namespace

CellStacks::CellStacks(const Mesh& mesh)
  : mesh_(mesh),
    cellsAt_(mesh.points.size(),
      [&](const auto& use)
      {
        Index number = 0;
        visitOwnShapes(mesh,
          [&](auto shape, const auto& cells)
          {
            for (const auto& cell : cells)
            {
              if (standsOnAnother(shape))
              {
                std::for_each(cell.begin(), cell.end(), [&](Index v) { use(v, number); });
              }
              ++number;
            }
          });
      })
{
}

Facet CellStacks::opposite(const Facet& side) const
{
  Facet result;
  visitCell(mesh_, side.cell,
    [&](auto shape, const auto& corners)
    {
      const std::size_t count = side.corners();
      for (std::size_t k = 0; k < count; ++k)
      {
        const Index other = leaving(shape, corners, side, side.vertices[k]);
        if (other < 0 || has(result.vertices, other)) // a wedge on one of its quadrilaterals
        {
          result = {};
          return;
        }
        result.vertices[k] = other;
      }
      result.cell = side.cell;
    });
  return result;
}

Facet CellStacks::beyond(const Facet& side) const
{
  Facet result = side;
  result.cell = -1;
  const auto [first, last] = cellsAt_.at(side.vertices[0]);
  for (const Index* cell = first; cell != last; ++cell)
  {
    if (*cell != side.cell)
    {
      visitCell(mesh_, *cell,
        [&](auto, const auto& corners)
        {
          if (std::all_of(side.begin(), side.end(), [&](Index v) { return has(corners, v); }))
          {
            result.cell = *cell;
          }
        });
    }
  }
  return result;
}

} // namespace cadrefine
