#include <cadrefine/motion/MoveGuard.h>

#include <cadrefine/base/LargeMemory.h>
#include <cadrefine/base/SortUniquely.h>
#include <cadrefine/mesh/VertexFlags.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace cadrefine
{
namespace
{

const double smallestFraction = std::ldexp(1.0, -MoveGuard::maximumHalvings);

std::vector<unsigned char> movingVertices(const Moves& moves)
{
  std::vector<unsigned char> flags(moves.fractions.size());
  std::transform(moves.fractions.begin(), moves.fractions.end(), flags.begin(),
    [](double fraction) { return fraction > 0; });
  return flags;
}

/// The state of a cell by stateAt; a quadrilateral, whose corners may turn out of a plane, is also
/// seen from its own side, as when its validity is checked.
template<class Shape>
CellState stateFrom(Shape shape, const std::array<Point3, Shape::corners>& p, const Vector3& side,
  double enough = infiniteQuality)
{
  CellState state = stateAt(shape, p, side, enough);
  if constexpr (Shape::dimension == 2 && Shape::corners == 4)
  {
    const CellState own = stateAt(shape, p, sideOf(shape, p, {}));
    state = { state.valid && own.valid, std::min(state.quality, own.quality) };
  }
  return state;
}

} // namespace

MoveGuard::MoveGuard(const Mesh& mesh, const Moves& moves, const std::vector<Point3>& reference,
  const Vector3& plane, const ParallelFor& parallelFor)
  : MoveGuard(
      mesh, moves, reference, plane, cellsAt(mesh, movingVertices(moves), parallelFor), parallelFor)
{
}

MoveGuard::MoveGuard(const Mesh& mesh, const Moves& moves, const std::vector<Point3>& reference,
  const Vector3& plane, const std::vector<Index>& cells, const ParallelFor& parallelFor)
  : mesh_(mesh), parallelFor_(parallelFor)
{
  std::size_t first = 0;
  std::size_t place = 0;
  visitOwnShapes(mesh,
    [&](auto shape, const auto& all)
    {
      guarded_[place++] =
        guard(shape, cellsOfShape(cells, first, all.size()), moves, reference, plane);
      first += all.size();
    });
}

template<class Shape>
std::vector<MoveGuard::GuardedCell> MoveGuard::guard(Shape shape, std::vector<Index> chosen,
  const Moves& moves, const std::vector<Point3>& reference, const Vector3& plane) const
{
  const auto& cells = mesh_.*Shape::cells;
  chosen.erase(std::remove_if(chosen.begin(), chosen.end(),
                 [&](Index c)
                 {
                   return std::none_of(cells[c].begin(), cells[c].end(),
                     [&](Index vertex) { return moves.fractions[vertex] > 0; });
                 }),
    chosen.end());
  std::vector<GuardedCell> result;
  resizeLong(result, chosen.size(), parallelFor_);
  const auto look = [&](GuardedCell& guarded, Index number)
  {
    guarded.cell = number;
    const auto& cell = cells[number];
    const auto before = cornersOf(cell, reference);
    guarded.side = sideOf(shape, before, plane);
    guarded.before = stateFrom(shape, before, guarded.side);
    if (!guarded.before.valid) // once mended, it stays so
    {
      guarded.before = stateFrom(shape, cornersOf(cell, mesh_.points), guarded.side);
    }
    const double quality = guarded.before.quality;
    const double half = Shape::corners == shapes::Pyramid::corners
                          ? pyramidFloor
                          : std::clamp(0.5 * quality, lowestQuality, qualityFloor);
    guarded.leastQuality = guarded.before.valid ? std::min(half, quality) : quality;
  };
  forEachIndex(
    parallelFor_, chosen.size(), fineGrain, [&](std::size_t i) { look(result[i], chosen[i]); });
  return result;
}

template<class Shape>
bool MoveGuard::accepts(Shape shape, const GuardedCell& guarded, const Moves& moves) const
{
  const auto& cell = (mesh_.*Shape::cells)[guarded.cell];
  std::array<Point3, Shape::corners> points;
  std::transform(cell.begin(), cell.end(), points.begin(),
    [&](Index vertex) { return moves.position(mesh_.points, vertex); });
  const CellState after = stateFrom(shape, points, guarded.side, guarded.leastQuality);
  return after.valid >= guarded.before.valid && after.quality >= guarded.leastQuality;
}

/// The corners of the guarded cells for which holds(shape, guarded).
template<class Predicate>
std::vector<Index> MoveGuard::cornersWhere(const Predicate& holds) const
{
  std::vector<Index> all;
  std::size_t place = 0;
  visitOwnShapes(mesh_,
    [&](auto shape, const auto& cells)
    {
      const auto& guarded = guarded_[place++];
      const auto found = collect<Index>(parallelFor_, guarded.size(), fineGrain,
        [&](std::size_t begin, std::size_t end, std::vector<Index>& corners)
        {
          for (std::size_t i = begin; i < end; ++i)
          {
            if (holds(shape, guarded[i]))
            {
              const auto& cell = cells[guarded[i].cell];
              corners.insert(corners.end(), cell.begin(), cell.end());
            }
          }
        });
      all.insert(all.end(), found.begin(), found.end());
    });
  return all;
}

bool MoveGuard::halveUnaccepted(Moves& moves)
{
  const auto hasChanged = [&](const auto& cell)
  {
    return lastFractions_.empty() ||
           std::any_of(cell.begin(), cell.end(),
             [&](Index vertex) { return moves.fractions[vertex] != lastFractions_[vertex]; });
  };
  std::vector<Index> vertices = cornersWhere(
    [&](auto shape, const GuardedCell& guarded)
    {
      return hasChanged((mesh_.*decltype(shape)::cells)[guarded.cell]) &&
             !accepts(shape, guarded, moves);
    });
  lastFractions_ = moves.fractions;
  sortUniquely(vertices);
  bool halved = false;
  for (const Index vertex : vertices)
  {
    double& fraction = moves.fractions[vertex];
    if (fraction > 0)
    {
      fraction = fraction > smallestFraction && !moves.whole[vertex] ? 0.5 * fraction : 0;
      halved = true;
    }
  }
  return halved;
}

std::vector<Index> MoveGuard::verticesOfSpoiltCells(double part) const
{
  return cornersWhere(
    [&](auto shape, const GuardedCell& guarded)
    {
      const auto& cell = (mesh_.*decltype(shape)::cells)[guarded.cell];
      const double least = part * guarded.before.quality;
      const CellState now = stateFrom(shape, cornersOf(cell, mesh_.points), guarded.side, least);
      return guarded.before.valid && now.quality < least;
    });
}

} // namespace cadrefine
