#include "mesh/PieceCheck.h"

#include "comm/GlobalNumbering.h"
#include "comm/SharedEdges.h"
#include "comm/Threads.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/base/VertexBuckets.h>

#include <algorithm>
#include <limits>
#include <mutex>
#include <sstream>
#include <string>
#include <utility>

namespace cadrefine
{
namespace
{

constexpr GlobalId none = std::numeric_limits<GlobalId>::max();

std::string textOf(const Point3& point)
{
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  text << "(" << point[0] << ", " << point[1] << ", " << point[2] << ")";
  return text.str();
}

/// The smallest number that occurs twice among those of all ranks; `none` where there is none.
/// Collective; every number is sent once.
GlobalId smallestTwice(RankExchange& exchange, const std::vector<GlobalId>& numbers)
{
  std::vector<std::vector<GlobalId>> toRank(exchange.size());
  for (const GlobalId number : numbers)
  {
    toRank[number % exchange.size()].push_back(number);
  }
  std::vector<GlobalId> kept;
  for (const auto& list : exchange.allToAll(toRank))
  {
    kept.insert(kept.end(), list.begin(), list.end());
  }
  std::sort(kept.begin(), kept.end());
  const auto twins = std::adjacent_find(kept.begin(), kept.end());
  return exchange.min(twins == kept.end() ? none : *twins);
}

bool areDistinct(RankExchange& exchange, const std::vector<GlobalId>& numbers)
{
  try
  {
    denseOffsets(exchange, numbers, std::vector<Index>(numbers.size(), 1));
    return true;
  }
  catch (const AgreedError&) // not where a rank has failed
  {
    return false;
  }
}

/// Text for an Error: two ranks that own a vertex with this id, and where each has it. Collective.
std::string describeTwins(
  RankExchange& exchange, const Mesh& mesh, const std::vector<char>& owned, GlobalId id)
{
  std::vector<double> mine(4, 0);
  for (std::size_t v = 0; v < mesh.ids.size(); ++v)
  {
    if (owned[v] && mesh.ids[v] == id)
    {
      mine = { 1, mesh.points[v][0], mesh.points[v][1], mesh.points[v][2] };
    }
  }
  const auto gathered = exchange.gather(mine);
  std::vector<std::string> places;
  std::vector<std::string> ranks;
  for (int rank = 0; rank < exchange.size(); ++rank)
  {
    const double* entry = gathered.data() + 4 * static_cast<std::ptrdiff_t>(rank);
    if (entry[0] > 0)
    {
      places.push_back(textOf({ entry[1], entry[2], entry[3] }));
      ranks.push_back(std::to_string(rank));
    }
  }
  if (places[0] == places[1])
  {
    return "pieces of the mesh overlap: ranks " + ranks[0] + " and " + ranks[1] +
           " both have cells around the point " + places[0] +
           " (a cell that several ranks hold must be marked as a ghost on all but one)";
  }
  return "two points of the mesh have the global id " + std::to_string(id) + ": " + places[0] +
         " on rank " + ranks[0] + " and " + places[1] + " on rank " + ranks[1];
}

void checkIds(RankExchange& exchange, const DistributedMesh& mesh)
{
  const Mesh& piece = mesh.mesh();
  const auto owned = mesh.shared.ownedHere(static_cast<Index>(piece.ids.size()));
  std::vector<GlobalId> ids;
  for (std::size_t v = 0; v < owned.size(); ++v)
  {
    if (owned[v])
    {
      ids.push_back(piece.ids[v]);
    }
  }
  if (!areDistinct(exchange, ids))
  {
    throw Error(describeTwins(exchange, piece, owned, smallestTwice(exchange, ids)));
  }
}

void checkInterface(RankExchange& exchange, const DistributedMesh& mesh)
{
  const Mesh& piece = mesh.mesh();
  std::vector<Point3> points = piece.points;
  copyFromOwners(exchange, mesh.shared, points);
  const auto other = std::find_if(mesh.shared.all.begin(), mesh.shared.all.end(),
    [&](Index vertex) { return points[vertex] != piece.points[vertex]; });
  exchange.agree(other == mesh.shared.all.end()
                   ? ""
                   : "pieces of the mesh do not match: the point with global id " +
                       std::to_string(piece.ids[*other]) + " is at " + textOf(points[*other]) +
                       " on rank " + std::to_string(mesh.shared.owner(*other)) + " and at " +
                       textOf(piece.points[*other]) + " on rank " +
                       std::to_string(exchange.rank()));
}

/// The vertices of a cell, ascending, and its number.
template<std::size_t Corners>
using SortedCell = std::pair<std::array<Index, Corners>, Index>;

/// Two of these cells that have the same vertices; empty if there are none.
template<std::size_t Corners>
std::vector<Index> twinsAmong(std::vector<SortedCell<Corners>>& cells)
{
  std::sort(cells.begin(), cells.end());
  const auto found = std::adjacent_find(
    cells.begin(), cells.end(), [](const auto& a, const auto& b) { return a.first == b.first; });
  return found == cells.end() ? std::vector<Index>{}
                              : std::vector<Index>{ found[0].second, found[1].second };
}

/// Two cells of the piece that have the same vertices, those with the smallest; empty if there are
/// none.
template<std::size_t Corners>
std::vector<Index> twinsInPiece(
  std::size_t vertexCount, const Cells<Corners>& cells, const ParallelFor& parallelFor)
{
  const auto visit = [&](std::size_t begin, std::size_t end, const auto& use)
  {
    for (std::size_t c = begin; c < end; ++c)
    {
      use(*std::min_element(cells[c].begin(), cells[c].end()), static_cast<Index>(c));
    }
  };
  const VertexBuckets<Index> cellsAt(vertexCount, cells.size(), visit, parallelFor);
  std::vector<Index> twins;
  std::size_t lowest = vertexCount; // vertex with twins
  std::mutex mutex;
  parallelFor(vertexCount, fineGrain,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<SortedCell<Corners>> sorted;
      for (std::size_t v = begin; v < end; ++v)
      {
        const auto [first, last] = cellsAt.at(static_cast<Index>(v));
        sorted.clear();
        for (const Index* cell = first; cell != last; ++cell)
        {
          auto& [corners, number] = sorted.emplace_back(cells[*cell], *cell);
          std::sort(corners.begin(), corners.end());
        }
        if (auto found = twinsAmong<Corners>(sorted); !found.empty())
        {
          const std::lock_guard<std::mutex> lock(mutex);
          twins = v < lowest ? std::move(found) : twins;
          lowest = std::min(lowest, v);
        }
      }
    });
  return twins;
}

/// Throws Error on all ranks where a cell is listed twice, on one rank or on two. `numbers` are
/// those of the cells in the data set.
template<std::size_t Corners>
void checkCells(RankExchange& exchange, const DistributedMesh& mesh, const Cells<Corners>& cells,
  const vtkIdType* numbers)
{
  const auto twins = twinsInPiece(mesh.mesh().points.size(), cells, forOnThreads(exchange));
  exchange.agree(twins.empty()
                   ? ""
                   : "the mesh has duplicate cells: " + std::to_string(numbers[twins[0]]) +
                       " and " + std::to_string(numbers[twins[1]]) + " of rank " +
                       std::to_string(exchange.rank()) +
                       " have the same points (merge them with the filter Clean Cells to "
                       "Grid)");
  const SharedItems shared =
    findSharedCells<Corners>(exchange, mesh.shared, mesh.mesh().ids, cells);
  if (exchange.any(!shared.all.empty()))
  {
    const auto holders = shared.all.empty() ? SharedItems::Ranks{} : shared.holdersOfSlot(0);
    exchange.agree(shared.all.empty()
                     ? ""
                     : "the mesh has duplicate cells: cell " +
                         std::to_string(numbers[shared.all[0]]) + " of rank " +
                         std::to_string(exchange.rank()) + " is also on rank " +
                         std::to_string(holders.first[holders.lowest() == exchange.rank()]) +
                         " (a cell that several ranks hold must be marked as a ghost on all but "
                         "one)");
  }
}

/// Text for an Error: the corners of this rank's cells of this dimension with this id.
std::string cornersOf(
  const Mesh& mesh, int dimension, const std::vector<GlobalId>& ids, GlobalId id)
{
  std::string text;
  auto next = ids.begin();
  visitShapes(mesh, dimension,
    [&](auto, const auto& cells)
    {
      const auto end = next + static_cast<std::ptrdiff_t>(cells.size());
      const auto found = std::find(next, end, id);
      if (found != end)
      {
        for (const Index vertex : cells[found - next])
        {
          text += " " + textOf(mesh.points[vertex]);
        }
      }
      next = end;
    });
  return text;
}

} // namespace

void checkPieces(RankExchange& exchange, const DistributedMesh& mesh)
{
  if (exchange.size() > 1)
  {
    checkInterface(exchange, mesh);
    checkIds(exchange, mesh);
  }
  const Mesh& piece = mesh.mesh();
  const vtkIdType* numbers = mesh.converted.cellOf[piece.dimension].data();
  if (piece.dimension > 1)
  {
    visitOwnShapes(piece,
      [&](auto, const auto& cells)
      {
        if (exchange.any(!cells.empty()))
        {
          checkCells(exchange, mesh, cells, numbers);
        }
        numbers += cells.size();
      });
  }
}

void complainOfRepeatedCells(
  RankExchange& exchange, const Mesh& mesh, const std::array<std::vector<GlobalId>, 4>& cellIds)
{
  std::vector<GlobalId> all;
  for (const auto& ids : cellIds)
  {
    all.insert(all.end(), ids.begin(), ids.end());
  }
  const GlobalId id = smallestTwice(exchange, all);
  std::string corners;
  for (int d = 0; d < 4; ++d)
  {
    corners += cornersOf(mesh, d, cellIds[d], id);
  }
  exchange.agree(corners.empty()
                   ? ""
                   : "two cells of the mesh have the same global id (" + std::to_string(id) +
                       "); the corners of one are" + corners +
                       " (remove the array of global cell ids, or make it anew with the filter "
                       "Generate Global Ids)");
  throw Error("two cells of the mesh have the same global id");
}

} // namespace cadrefine
