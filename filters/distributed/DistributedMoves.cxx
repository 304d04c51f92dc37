#include "DistributedMoves.h"

#include "InteriorSmoothing.h"

#include <algorithm>

namespace cadrefine
{
namespace
{

constexpr int maximumRounds = 20;
/// After so many rounds the region that gives way grows by a ring of cells.
constexpr int roundsARing = 4;

/// Halves the moves until every cell of every rank accepts them, then makes them.
void settle(
  RankExchange& exchange, DistributedMesh& mesh, const std::vector<Point3>& reference, Moves& moves)
{
  const MoveGuard guard(mesh.mesh(), reference);
  bool halved = true;
  while (halved)
  {
    halved = exchange.any(guard.halveUnaccepted(moves));
    combineShared(
      exchange, mesh.shared, moves.fractions, [](double a, double b) { return std::min(a, b); });
  }
  std::vector<Point3> positions(mesh.mesh().points.size());
  for (std::size_t v = 0; v < positions.size(); ++v)
  {
    positions[v] = moves.position(mesh.mesh(), static_cast<Index>(v));
  }
  mesh.mesh().points = std::move(positions);
}

ProposalGrid makeGrid(RankExchange& exchange, const SimplexMesh& mesh)
{
  const auto [low, high] = findBounds(exchange, mesh);
  return { low, std::max({ high[0] - low[0], high[1] - low[1], high[2] - low[2] }) };
}

/// Vertices that did not reach their targets, and the number of them over all ranks.
struct StuckVertices
{
  std::vector<unsigned char> flags;
  std::int64_t count = 0;
};

StuckVertices findStuck(RankExchange& exchange, const DistributedMesh& mesh, const Moves& moves)
{
  const auto owned = mesh.shared.ownedHere(static_cast<Index>(mesh.mesh().points.size()));
  StuckVertices stuck;
  stuck.flags.resize(owned.size());
  std::int64_t count = 0;
  for (std::size_t v = 0; v < owned.size(); ++v)
  {
    stuck.flags[v] = mesh.mesh().points[v] != moves.targets[v];
    count += owned[v] && stuck.flags[v];
  }
  stuck.count = exchange.sum(count);
  return stuck;
}

template<std::size_t Corners>
void growOverCells(const std::vector<std::array<Index, Corners>>& cells,
  const std::vector<unsigned char>& flags, std::vector<unsigned char>& grown)
{
  for (const auto& cell : cells)
  {
    if (std::any_of(cell.begin(), cell.end(), [&](Index vertex) { return flags[vertex] != 0; }))
    {
      for (const Index vertex : cell)
      {
        grown[vertex] = 1;
      }
    }
  }
}

/// The flags and those of all vertices that share a cell with a flagged one, `rings` times.
std::vector<unsigned char> grow(
  RankExchange& exchange, const DistributedMesh& mesh, std::vector<unsigned char> flags, int rings)
{
  for (int ring = 0; ring < rings; ++ring)
  {
    auto grown = flags;
    growOverCells(mesh.mesh().tetrahedra, flags, grown);
    growOverCells(mesh.mesh().triangles, flags, grown);
    combineShared(exchange, mesh.shared, grown,
      [](unsigned char a, unsigned char b) { return std::max(a, b); });
    flags = std::move(grown);
  }
  return flags;
}

/// Moves of the stuck vertices, and of the interior vertices of the cells around them and of so
/// many rings of cells more.
Moves nextMoves(RankExchange& exchange, const DistributedMesh& mesh, const Moves& moves,
  const std::vector<unsigned char>& interior, const StuckVertices& stuck, const ProposalGrid& grid,
  int rings)
{
  Moves next(mesh.mesh());
  auto proposals = proposeInteriorPositions(
    mesh.mesh(), moves.targets, interior, grow(exchange, mesh, stuck.flags, rings), grid);
  combineShared(
    exchange, mesh.shared, proposals, [](const Proposal& a, const Proposal& b) { return a + b; });
  for (std::size_t v = 0; v < proposals.size(); ++v)
  {
    if (stuck.flags[v])
    {
      next.add(static_cast<Index>(v), moves.targets[v]);
    }
    else if (proposals[v].weight > 0)
    {
      next.add(static_cast<Index>(v), grid.position(proposals[v]));
    }
  }
  return next;
}

} // namespace

std::vector<double> moveVertices(RankExchange& exchange, DistributedMesh& mesh, const Moves& moves,
  const std::vector<unsigned char>& onBoundary)
{
  const std::vector<Point3> reference = mesh.mesh().points;
  Moves wanted = moves;
  settle(exchange, mesh, reference, wanted);
  StuckVertices stuck = findStuck(exchange, mesh, wanted);
  if (stuck.count > 0)
  {
    const ProposalGrid grid = makeGrid(exchange, mesh.mesh());
    std::vector<unsigned char> interior(onBoundary.size());
    for (std::size_t v = 0; v < interior.size(); ++v)
    {
      interior[v] = !onBoundary[v] && moves.fractions[v] == 0;
    }
    for (int round = 0; round < maximumRounds && stuck.count > 0; ++round)
    {
      Moves next = nextMoves(exchange, mesh, wanted, interior, stuck, grid, round / roundsARing);
      settle(exchange, mesh, reference, next);
      for (std::size_t v = 0; v < interior.size(); ++v)
      {
        wanted.targets[v] = interior[v] ? mesh.mesh().points[v] : wanted.targets[v];
      }
      stuck = findStuck(exchange, mesh, wanted);
    }
  }
  std::vector<double> remaining(wanted.targets.size());
  for (std::size_t v = 0; v < remaining.size(); ++v)
  {
    remaining[v] = distance(mesh.mesh().points[v], wanted.targets[v]);
  }
  return remaining;
}

} // namespace cadrefine
