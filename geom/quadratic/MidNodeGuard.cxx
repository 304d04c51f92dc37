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

bool isCellValid(
  const SimplexMesh&, const std::array<Index, 4>&, const Vector3&, const CurvedTetrahedron& nodes)
{
  return isValid(nodes);
}

bool isCellValid(const SimplexMesh& mesh, const std::array<Index, 3>& cell, const Vector3& plane,
  const CurvedTriangle& nodes)
{
  return isValid(nodes, sideOfCell(mesh, cell, plane));
}

template<class Edges>
bool stepBackWhere(const std::vector<Index>& cells, const std::vector<unsigned char>& invalid,
  const Edges& edgesOf, const std::vector<double>& before, std::vector<double>& fractions)
{
  bool any = false;
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    if (!invalid[i])
    {
      continue;
    }
    for (const Index edge : edgesOf[cells[i]])
    {
      if (before[edge] > 0)
      {
        fractions[edge] = stepped(before[edge]);
        any = true;
      }
    }
  }
  return any;
}

} // namespace

MidNodeMoves::MidNodeMoves(const SimplexMesh& mesh, const EdgeTable& table)
  : fractions(table.edges.size(), 0.0)
{
  middles.reserve(table.edges.size());
  for (const auto& ends : table.edges)
  {
    middles.push_back(middleOf(mesh, ends));
  }
  targets = middles;
}

void MidNodeMoves::add(Index edge, const Point3& target)
{
  targets[edge] = target;
  fractions[edge] = 1;
}

Point3 MidNodeMoves::position(Index edge) const
{
  const double fraction = fractions[edge];
  if (fraction == 1)
  {
    return targets[edge];
  }
  const Point3& middle = middles[edge];
  return fraction == 0 ? middle : middle + fraction * (targets[edge] - middle);
}

MidNodeGuard::MidNodeGuard(const SimplexMesh& mesh, const EdgeTable& table,
  const MidNodeMoves& moves, const Vector3& plane, const ParallelFor& parallelFor)
  : mesh_(mesh), table_(table), plane_(plane), parallelFor_(parallelFor),
    cells_(mesh.dimension == 3 ? cellsWhere(table.ofTetrahedra, moves.fractions)
                               : cellsWhere(table.ofTriangles, moves.fractions)),
    seen_(moves.fractions.size(), -1.0)
{
}

template<std::size_t Count>
bool MidNodeGuard::hasChanged(
  const std::array<Index, Count>& edges, const MidNodeMoves& moves) const
{
  return std::any_of(
    edges.begin(), edges.end(), [&](Index edge) { return moves.fractions[edge] != seen_[edge]; });
}

template<class Cells, class Edges>
std::vector<unsigned char> MidNodeGuard::findInvalid(
  const Cells& cells, const Edges& edgesOf, const MidNodeMoves& moves) const
{
  std::vector<unsigned char> invalid(cells_.size(), 0);
  const auto nodeAt = [&](Index edge) { return moves.position(edge); };
  forEachIndex(parallelFor_, cells_.size(), fineGrain,
    [&](std::size_t i)
    {
      const auto& cell = cells[cells_[i]];
      const auto& edges = edgesOf[cells_[i]];
      invalid[i] = hasChanged(edges, moves) &&
                   !isCellValid(mesh_, cell, plane_, gatherNodes(mesh_, cell, edges, nodeAt));
    });
  return invalid;
}

bool MidNodeGuard::stepBack(MidNodeMoves& moves)
{
  const std::vector<unsigned char> invalid =
    mesh_.dimension == 3 ? findInvalid(mesh_.tetrahedra, table_.ofTetrahedra, moves)
                         : findInvalid(mesh_.triangles, table_.ofTriangles, moves);
  seen_ = moves.fractions;
  return mesh_.dimension == 3
           ? stepBackWhere(cells_, invalid, table_.ofTetrahedra, seen_, moves.fractions)
           : stepBackWhere(cells_, invalid, table_.ofTriangles, seen_, moves.fractions);
}

} // namespace cadrefine
