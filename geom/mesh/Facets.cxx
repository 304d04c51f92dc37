#include "Facets.h"

#include <algorithm>

namespace cadrefine
{
namespace
{

/// Counts how often each side is met, in a chain of the side's smallest vertex.
class SideCounter
{
public:
  explicit SideCounter(std::size_t vertexCount) : firstOfVertex_(vertexCount, -1) {}

  void add(const Facet& side)
  {
    std::array<Index, 3> key = side.vertices;
    std::sort(key.begin(), key.end());
    const Index first = key[0] >= 0 ? key[0] : key[1];
    for (Index s = firstOfVertex_[first]; s >= 0; s = next_[s])
    {
      if (keys_[s] == key)
      {
        met_[s] = 2;
        return;
      }
    }
    next_.push_back(firstOfVertex_[first]);
    firstOfVertex_[first] = static_cast<Index>(keys_.size());
    keys_.push_back(key);
    sides_.push_back(side);
    met_.push_back(1);
  }

  std::vector<Facet> metOnce() const
  {
    std::vector<Facet> result;
    for (std::size_t s = 0; s < sides_.size(); ++s)
    {
      if (met_[s] == 1)
      {
        result.push_back(sides_[s]);
      }
    }
    return result;
  }

private:
  std::vector<Index> firstOfVertex_;
  std::vector<Index> next_;
  std::vector<std::array<Index, 3>> keys_;
  std::vector<Facet> sides_;
  std::vector<unsigned char> met_;
};

} // namespace

std::vector<Facet> findOuterFacets(const SimplexMesh& mesh)
{
  SideCounter counter(mesh.points.size());
  if (mesh.dimension == 3)
  {
    for (std::size_t c = 0; c < mesh.tetrahedra.size(); ++c)
    {
      const auto& cell = mesh.tetrahedra[c];
      for (const auto& face : tetrahedronFaces)
      {
        counter.add({ { cell[face[0]], cell[face[1]], cell[face[2]] }, static_cast<Index>(c) });
      }
    }
    return counter.metOnce();
  }
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c)
  {
    const auto& cell = mesh.triangles[c];
    for (const auto& edge : triangleEdges)
    {
      counter.add({ { cell[edge[0]], cell[edge[1]], -1 }, static_cast<Index>(c) });
    }
  }
  return counter.metOnce();
}

std::vector<Facet> facetsOfSurface(const SimplexMesh& mesh)
{
  std::vector<Facet> facets;
  facets.reserve(mesh.triangles.size());
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c)
  {
    facets.push_back({ mesh.triangles[c], static_cast<Index>(c) });
  }
  return facets;
}

} // namespace cadrefine
