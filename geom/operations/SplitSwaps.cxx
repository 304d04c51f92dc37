#include <cadrefine/operations/SplitSwaps.h>

#include <cadrefine/operations/Operations.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

namespace cadrefine
{
namespace
{

/// Finds, of the removals of edges opposite to a vertex, the one whose worst new cell is best.
/// Returns false where none gains.
template<int Dimension>
bool findSwap(const EditableMesh& mesh, Index middle, Cavity& best)
{
  const SimplexStore<Dimension + 1>& cells = mesh.cellsOf<Dimension>();
  double bestQuality = -std::numeric_limits<double>::infinity();
  Cavity cavity;
  std::vector<std::array<Index, 2>> edges; // each is opposite in two cells
  const auto isNew = [&](Index a, Index b)
  {
    return std::none_of(edges.begin(), edges.end(),
      [&](const auto& edge) { return hasCorner(edge, a) && hasCorner(edge, b); });
  };
  const auto consider = [&](Index a, Index b)
  {
    if (!proposeEdgeRemoval(mesh, a, b, cavity, NewCells::NoWorse))
    {
      return;
    }
    double worst = std::numeric_limits<double>::infinity();
    for (const auto& cell : cavity.newCellsOf<Dimension>())
    {
      worst = std::min(worst, mesh.quality(cell.corners));
    }
    if (worst > bestQuality && worst > mesh.worst(cavity.cellsOf<Dimension>()) &&
        mesh.isValid(cavity))
    {
      bestQuality = worst;
      best = cavity;
    }
  };
  for (const Index cell : cells.at(middle))
  {
    const auto& corners = cells[cell].corners;
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
      for (std::size_t j = i + 1; j < corners.size(); ++j)
      {
        if (corners[i] != middle && corners[j] != middle && isNew(corners[i], corners[j]))
        {
          edges.push_back({ corners[i], corners[j] });
          consider(corners[i], corners[j]);
        }
      }
    }
  }
  return bestQuality > -std::numeric_limits<double>::infinity();
}

} // namespace

void swapRoundMiddle(EditableMesh& mesh, Index middle, Cavity& cavity)
{
  std::vector<Cavity> done{ std::move(cavity) };
  mesh.replace(done.back());
  Cavity swap;
  while (mesh.dimension() == 3 ? findSwap<3>(mesh, middle, swap) : findSwap<2>(mesh, middle, swap))
  {
    mesh.replace(swap);
    done.push_back(std::move(swap));
  }
  cavity = mesh.takeBack(done);
}

} // namespace cadrefine
