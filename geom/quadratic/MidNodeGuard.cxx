#include <cadrefine/quadratic/MidNodeGuard.h>

#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/quadratic/MidNodes.h>

#include <algorithm>
#include <cmath>

namespace cadrefine
{
namespace
{

const double smallestFraction = std::ldexp(1.0, -MidNodeGuard::maximumHalvings);

double stepped(double fraction)
{
  const double rest = 1 - fraction;
  if (rest < 0.5)
  {
    return 1 - std::max(2 * rest, MidNodeGuard::firstStep);
  }
  return fraction > smallestFraction ? fraction / 2 : 0;
}

template<class Edges>
std::vector<Index> cellsWhere(const Edges& edgesOf, const std::vector<double>& fractions)
{
  const auto moves = [&](Index edge) { return fractions[edge] > 0; };
  return indicesWhere(edgesOf.size(),
    [&](std::size_t c) { return std::any_of(edgesOf[c].begin(), edgesOf[c].end(), moves); });
}

/// Takes the nodes of these edges back a step. Returns whether it took any.
template<class Edges>
bool stepBackAt(
  const Edges& edges, const std::vector<double>& before, std::vector<double>& fractions)
{
  bool any = false;
  for (const Index edge : edges)
  {
    if (before[edge] > 0)
    {
      fractions[edge] = stepped(before[edge]);
      any = true;
    }
  }
  return any;
}

} // namespace

std::vector<unsigned char> midNodesOfPyramids(const EdgeTable& table)
{
  std::vector<unsigned char> flags(table.edges.size(), 0);
  for (const auto& edges : table.ofPyramids)
  {
    for (const Index edge : edges)
    {
      flags[edge] = 1;
    }
  }
  return flags;
}

MidNodeGuard::MidNodeGuard(const Mesh& mesh, const EdgeTable& table,
  const std::vector<Point3>& middles, const Moves& moves, const Vector3& plane,
  const ParallelFor& parallelFor)
  : mesh_(mesh), table_(table), middles_(middles), plane_(plane), parallelFor_(parallelFor),
    seen_(moves.fractions.size(), -1.0), tooCurved_(mesh.cellCount(mesh.dimension), 0)
{
  visitOwnShapes(mesh, [&](auto shape, const auto&)
    { cells_.push_back(cellsWhere(table.*edgesOfCells(shape), moves.fractions)); });
}

template<class Shape>
std::vector<unsigned char> MidNodeGuard::findInvalid(
  Shape shape, const std::vector<Index>& cells, const Moves& moves) const
{
  std::vector<unsigned char> invalid(cells.size(), 0);
  const auto nodeAt = [&](Index edge) { return moves.position(middles_, edge); };
  const auto hasChanged = [&](Index edge) { return moves.fractions[edge] != seen_[edge]; };
  forEachIndex(parallelFor_, cells.size(), fineGrain,
    [&](std::size_t i)
    {
      const Index c = cells[i];
      const auto& edges = (table_.*edgesOfCells(shape))[c];
      invalid[i] = std::any_of(edges.begin(), edges.end(), hasChanged) &&
                   !isCellValid(shape, mesh_, (mesh_.*Shape::cells)[c], edges, plane_, nodeAt);
    });
  return invalid;
}

bool MidNodeGuard::stepBack(Moves& moves)
{
  std::vector<std::vector<unsigned char>> invalid;
  visitOwnShapes(mesh_, [&](auto shape, const auto&)
    { invalid.push_back(findInvalid(shape, cells_[invalid.size()], moves)); });
  seen_ = moves.fractions;
  bool any = false;
  std::size_t s = 0;
  std::size_t first = 0;
  visitOwnShapes(mesh_,
    [&](auto shape, const auto& cells)
    {
      for (std::size_t i = 0; i < invalid[s].size(); ++i)
      {
        if (invalid[s][i])
        {
          const Index cell = cells_[s][i];
          const bool steps =
            stepBackAt((table_.*edgesOfCells(shape))[cell], seen_, moves.fractions);
          tooCurved_[first + cell] = steps;
          any |= steps;
        }
      }
      first += cells.size();
      ++s;
    });
  return any;
}

} // namespace cadrefine
