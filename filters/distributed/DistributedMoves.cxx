#include "DistributedMoves.h"

#include "InteriorSmoothing.h"

#include <algorithm>

namespace cadrefine
{
namespace
{

constexpr int maximumRounds = 10;

/// Halves the moves until every cell of every rank accepts them, then makes them.
void settle(RankExchange& exchange, DistributedMesh& mesh, Moves& moves)
{
  const MoveGuard guard(mesh.mesh());
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

/// Moves of the stuck vertices and of the interior vertices of the cells around them.
Moves nextMoves(RankExchange& exchange, const DistributedMesh& mesh, const Moves& moves,
  const std::vector<unsigned char>& interior, const StuckVertices& stuck, const ProposalGrid& grid)
{
  Moves next(mesh.mesh());
  auto proposals =
    proposeInteriorPositions(mesh.mesh(), moves.targets, interior, stuck.flags, grid);
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
  Moves wanted = moves;
  settle(exchange, mesh, wanted);
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
      Moves next = nextMoves(exchange, mesh, wanted, interior, stuck, grid);
      settle(exchange, mesh, next);
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
