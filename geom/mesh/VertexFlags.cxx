#include <cadrefine/mesh/VertexFlags.h>

#include <cadrefine/base/IndicesWhere.h>

#include <algorithm>

namespace cadrefine
{

std::vector<Index> cellsAt(
  const Mesh& mesh, const std::vector<unsigned char>& flags, const ParallelFor& parallelFor)
{
  std::vector<Index> all;
  Index first = 0;
  visitOwnShapes(mesh,
    [&](auto, const auto& cells)
    {
      const auto found = collect<Index>(parallelFor, cells.size(), fineGrain,
        [&](std::size_t begin, std::size_t end, std::vector<Index>& numbers)
        {
          for (std::size_t c = begin; c < end; ++c)
          {
            unsigned char any = 0;
            for (const Index vertex : cells[c])
            {
              any |= flags[vertex];
            }
            if (any)
            {
              numbers.push_back(first + static_cast<Index>(c));
            }
          }
        });
      all.insert(all.end(), found.begin(), found.end());
      first += static_cast<Index>(cells.size());
    });
  return all;
}

std::vector<Index> cellsOfShape(
  const std::vector<Index>& numbers, std::size_t first, std::size_t count)
{
  const auto at = [&](std::size_t number)
  { return std::lower_bound(numbers.begin(), numbers.end(), static_cast<Index>(number)); };
  std::vector<Index> ofShape(at(first), at(first + count));
  std::transform(ofShape.begin(), ofShape.end(), ofShape.begin(),
    [&](Index number) { return number - static_cast<Index>(first); });
  return ofShape;
}

void flagVertices(
  const Mesh& mesh, const std::vector<Index>& cells, std::vector<unsigned char>& flags)
{
  std::size_t first = 0;
  visitOwnShapes(mesh,
    [&](auto, const auto& all)
    {
      for (const Index cell : cellsOfShape(cells, first, all.size()))
      {
        for (const Index vertex : all[cell])
        {
          flags[vertex] = 1;
        }
      }
      first += all.size();
    });
}

std::vector<Index> usedVertices(const Mesh& mesh)
{
  std::vector<unsigned char> used(mesh.points.size(), 0);
  visitShapes(mesh,
    [&](auto, const auto& cells)
    {
      for (const auto& cell : cells)
      {
        for (const Index vertex : cell)
        {
          used[vertex] = 1;
        }
      }
    });
  return indicesWhere(used.size(), [&](std::size_t v) { return used[v] != 0; });
}

std::vector<Index> keepVertices(const std::vector<Index>& kept, Mesh& mesh)
{
  std::vector<Index> numbers(mesh.points.size(), -1);
  for (std::size_t i = 0; i < kept.size(); ++i)
  {
    numbers[kept[i]] = static_cast<Index>(i);
  }
  visitShapes(mesh,
    [&](auto, auto& cells)
    {
      for (auto& cell : cells)
      {
        for (Index& vertex : cell)
        {
          vertex = numbers[vertex];
        }
      }
    });
  keepOnly(kept, mesh.points);
  keepOnly(kept, mesh.ids);
  return numbers;
}

} // namespace cadrefine
