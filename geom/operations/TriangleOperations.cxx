#include <cadrefine/operations/TriangleOperations.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace cadrefine
{
namespace
{

/// The third corner of a facet at this edge.
Index apexOf(const std::array<Index, 3>& facet, Index a, Index b)
{
  return *std::find_if(
    facet.begin(), facet.end(), [&](Index vertex) { return vertex != a && vertex != b; });
}

bool contains(const std::vector<Index>& list, Index facet)
{
  return std::find(list.begin(), list.end(), facet) != list.end();
}

/// The facets at a vertex that hang together with one of them without a segment in between.
std::vector<Index> fanOf(const EditableMesh& mesh, Index vertex, Index facet)
{
  std::vector<Index> fan{ facet };
  for (std::size_t f = 0; f < fan.size(); ++f)
  {
    for (const Index other : mesh.facets()[fan[f]].corners)
    {
      if (other == vertex || mesh.segmentOf(vertex, other) >= 0)
      {
        continue;
      }
      for (const Index next : mesh.facets().at(vertex, other))
      {
        if (!contains(fan, next))
        {
          fan.push_back(next);
        }
      }
    }
  }
  return fan;
}

/// Whether a new facet of a surface in space, or an edge of it, may already exist beyond this mesh,
/// as between vertices with cells there round a hole or on the other side of something thin.
bool mayBeBeyond(const EditableMesh& mesh, const LabelledSimplex<3>& facet)
{
  int onRim = 0;
  for (int k = 0; k < 3; ++k)
  {
    const Index a = facet.corners[k];
    const Index b = facet.corners[(k + 1) % 3];
    onRim += mesh.vertex(a).isOnRim;
    if (mesh.areOnRim(a, b) && mesh.facets().at(a, b).empty())
    {
      return true;
    }
  }
  return onRim == 3;
}

bool mayBeBeyond(const EditableMesh& mesh, const Cavity& cavity)
{
  return mesh.kind() == EditableMesh::Kind::Surface &&
         std::any_of(cavity.newFacets.begin(), cavity.newFacets.end(),
           [&](const auto& facet) { return mayBeBeyond(mesh, facet); });
}

} // namespace

bool proposeSwap(const EditableMesh& mesh, Index a, Index b, Cavity& cavity)
{
  cavity.clear();
  cavity.facets = mesh.facets().at(a, b);
  if (cavity.facets.size() != 2 || mesh.segmentOf(a, b) >= 0 || mesh.areOnRim(a, b))
  {
    return false;
  }
  const LabelledSimplex<3>& facet = mesh.facets()[cavity.facets[0]];
  if (!goesAlong(facet.corners, a, b))
  {
    std::swap(a, b);
  }
  const Index first = apexOf(mesh.facets()[cavity.facets[1]].corners, a, b);
  const Index second = apexOf(facet.corners, a, b);
  if (first == second || !mesh.facets().at(first, second).empty())
  {
    return false;
  }
  cavity.newFacets = { { { a, first, second }, facet.label },
    { { first, b, second }, facet.label } };
  cavity.sides.assign(2, mesh.sideOf(cavity.facets));
  return !mayBeBeyond(mesh, cavity);
}

bool findSidesOfCollapse(const EditableMesh& mesh, Index from, Index to, Cavity& cavity)
{
  std::vector<std::vector<Index>> fans;
  for (const Index facet : mesh.facets().at(from, to))
  {
    fans.push_back(fanOf(mesh, from, facet));
  }
  for (const Index facet : cavity.facets)
  {
    const auto fan = std::find_if(
      fans.begin(), fans.end(), [&](const auto& list) { return contains(list, facet); });
    if (fan == fans.end())
    {
      return false;
    }
    if (!hasCorner(mesh.facets()[facet].corners, to))
    {
      cavity.sides.push_back(mesh.sideOf(*fan));
    }
  }
  return !mayBeBeyond(mesh, cavity);
}

void findSidesOfSplit(const EditableMesh& mesh, Cavity& cavity)
{
  for (const Index facet : cavity.facets)
  {
    cavity.sides.insert(cavity.sides.end(), 2, mesh.sideOf({ facet }));
  }
}

} // namespace cadrefine
