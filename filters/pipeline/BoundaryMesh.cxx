#include "pipeline/BoundaryMesh.h"

#include "comm/SharedEdges.h"
#include "fields/CADArrays.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/base/IndicesWhere.h>

#include <vtkCellData.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace cadrefine
{
namespace
{

/// Facets with so many corners each, and what they lie on.
struct ClassifiedFacets
{
  int corners = 3;
  std::vector<Facet> facets;
  std::vector<EntityId> entities;
};

/// The vertices that facets use, ascending.
std::vector<Index> verticesOf(const ClassifiedFacets& chosen, std::size_t vertexCount)
{
  std::vector<unsigned char> used(vertexCount, 0);
  for (const Facet& facet : chosen.facets)
  {
    for (int k = 0; k < chosen.corners; ++k)
    {
      used[facet.vertices[k]] = 1;
    }
  }
  return indicesWhere(vertexCount, [&](std::size_t v) { return used[v] != 0; });
}

SimplexMesh facetsAsCells(
  const SimplexMesh& mesh, const ClassifiedFacets& chosen, const std::vector<Index>& vertices)
{
  SimplexMesh result;
  std::vector<Index> placeOf(mesh.points.size(), -1);
  for (const Index vertex : vertices)
  {
    placeOf[vertex] = static_cast<Index>(result.points.size());
    result.points.push_back(mesh.points[vertex]);
    result.ids.push_back(mesh.ids[vertex]);
  }
  result.dimension = chosen.corners - 1;
  for (const Facet& facet : chosen.facets)
  {
    const auto& [a, b, c] = facet.vertices;
    if (result.dimension == 2)
    {
      result.triangles.push_back({ placeOf[a], placeOf[b], placeOf[c] });
    }
    else
    {
      result.segments.push_back({ placeOf[a], placeOf[b] });
    }
  }
  return result;
}

template<class Value, class Place>
std::vector<Value> taken(const std::vector<Value>& values, const std::vector<Place>& places)
{
  std::vector<Value> result;
  result.reserve(places.size());
  std::transform(places.begin(), places.end(), std::back_inserter(result),
    [&](Place place) { return values[place]; });
  return result;
}

/// Those on these faces; all where none are named. Collective.
ClassifiedFacets facetsAmong(
  const PipelineContext& context, MeshState& state, const std::vector<std::string>& faces)
{
  const std::vector<EntityId> entities = entitiesOfFacets(context, state);
  const DistributedBoundary& boundary = state.boundary->boundary;
  if (faces.empty())
  {
    return { boundary.facetCorners(), boundary.facets, entities };
  }
  const EntitySelection selection = selectFaces(context, state, faces);
  const std::vector<Index> chosen = indicesWhere(entities.size(),
    [&](std::size_t f) { return selection.contains(context.model.nurbs(), entities[f]); });
  if (!context.exchange.any(!chosen.empty()))
  {
    throw Error("none of the boundary's facets lies on the chosen faces (Faces)");
  }
  return { boundary.facetCorners(), taken(boundary.facets, chosen), taken(entities, chosen) };
}

void checkForBoundary(const SimplexMesh& mesh)
{
  if (mesh.dimension == 0)
  {
    throw Error("the mesh has no triangles or tetrahedra; points alone have no boundary");
  }
}

void writeAttributes(
  const CADModel& model, const std::vector<EntityId>& entities, vtkCellData* ofCells)
{
  writeEntities(ofCells, entities);
  writeNames(ofCells, arrays::name, model, entities);
  writeColours(ofCells, arrays::colour, model, entities);
}

/// What is known of the sides of a rank's cells: its facets first, then its listed cells of their
/// dimension.
struct Sides
{
  std::vector<EntityId> entities;
  std::vector<unsigned char> listed; ///< 1 where this rank or another lists it as a cell.
};

/// Facets know their entities, listed cells are to have those of their facets, whichever rank these
/// are on. Collective.
template<std::size_t N>
Sides compareWithListed(RankExchange& exchange, const DistributedMesh& mesh,
  const std::vector<Facet>& facets, const std::vector<EntityId>& ofFacets,
  const Simplices<N>& listed)
{
  Simplices<N> keys(facets.size() + listed.size());
  for (std::size_t f = 0; f < facets.size(); ++f)
  {
    std::copy_n(facets[f].vertices.begin(), N, keys[f].begin());
  }
  std::copy(listed.begin(), listed.end(), keys.begin() + facets.size());
  for (auto& key : keys)
  {
    std::sort(key.begin(), key.end());
  }
  Simplices<N> distinct = keys;
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  std::vector<EntityId> entities(distinct.size());
  std::vector<unsigned char> isListed(distinct.size(), 0);
  std::vector<std::size_t> placeOf(keys.size());
  for (std::size_t k = 0; k < keys.size(); ++k)
  {
    placeOf[k] = std::lower_bound(distinct.begin(), distinct.end(), keys[k]) - distinct.begin();
    k < facets.size() ? void(entities[placeOf[k]] = ofFacets[k]) : void(isListed[placeOf[k]] = 1);
  }
  const SharedItems shared =
    findSharedSimplices<N>(exchange, mesh.shared, mesh.mesh().ids, distinct);
  const auto larger = [](auto a, auto b) { return std::max(a, b); };
  combineShared(exchange, shared, entities, larger);
  combineShared(exchange, shared, isListed, larger);
  return { taken(entities, placeOf), taken(isListed, placeOf) };
}

/// Ids after those of all cells of the mesh.
template<std::size_t N>
std::vector<GlobalId> newIds(
  RankExchange& exchange, const DistributedMesh& mesh, const Simplices<N>& cells)
{
  GlobalId first = 0;
  for (const auto& ids : mesh.converted.cellIds)
  {
    first = std::accumulate(ids.begin(), ids.end(), first,
      [](GlobalId bound, GlobalId id) { return std::max(bound, id + 1); });
  }
  first = exchange.max(first);
  std::vector<GlobalId> ids = numberSimplices(exchange, mesh, cells);
  std::transform(ids.begin(), ids.end(), ids.begin(), [&](GlobalId id) { return first + id; });
  return ids;
}

template<class Value>
void append(std::vector<Value>& to, const std::vector<Value>& values)
{
  to.insert(to.end(), values.begin(), values.end());
}

/// The edges of a cell, as an EdgeTable lists them.
std::array<Index, 3> edgesOf(const EdgeTable& table, const std::array<Index, 3>& triangle)
{
  std::array<Index, 3> edges;
  std::transform(std::begin(triangleEdges), std::end(triangleEdges), edges.begin(),
    [&](const auto& ends) { return table.find(triangle[ends[0]], triangle[ends[1]]); });
  return edges;
}

Index edgesOf(const EdgeTable& table, const std::array<Index, 2>& segment)
{
  return table.find(segment[0], segment[1]);
}

/// Where cells `count` to `count + added` of what is made have none in what it is made from.
ArraySelection selectionWithout(vtkIdType count, vtkIdType added, vtkIdType cellCount)
{
  std::vector<vtkIdType> cells(cellCount + added, noTuple);
  std::iota(cells.begin(), cells.begin() + count, 0);
  std::iota(cells.begin() + count + added, cells.end(), count);
  return { {}, std::move(cells) };
}

/// See makeDataSetWithBoundary. Added facets begin at their smallest id, as VTK has the sides of
/// cells when it draws them: both are drawn alike, then, and colours are those of the cells.
///
/// `listed`: the mesh's cells of the facets' dimension; `edges`: theirs in the table of the mid
/// nodes.
template<std::size_t N, class Edges>
MeshWithBoundary makeWithFacets(const PipelineContext& context, MeshState& state,
  const std::vector<EntityId>& ofFacets, Simplices<N>& listed, std::vector<Edges> EdgeTable::*edges)
{
  ConvertedMesh& converted = state.mesh.converted;
  const std::vector<Facet>& facets = state.boundary->boundary.facets;
  const Sides sides = compareWithListed(context.exchange, state.mesh, facets, ofFacets, listed);
  const std::vector<Index> unlisted =
    indicesWhere(facets.size(), [&](std::size_t f) { return sides.listed[f] == 0; });
  Simplices<N> added(unlisted.size());
  for (std::size_t i = 0; i < unlisted.size(); ++i)
  {
    const auto corners = facets[unlisted[i]].vertices.begin();
    const auto first = std::min_element(corners, corners + N,
      [&](Index a, Index b) { return converted.mesh.ids[a] < converted.mesh.ids[b]; });
    std::rotate_copy(corners, first, corners + N, added[i].begin());
  }
  constexpr int dimension = static_cast<int>(N) - 1;
  const std::size_t listedCount = listed.size();
  const vtkIdType firstListed = firstCellOfDimension(converted.mesh, dimension);
  MeshWithBoundary result;
  result.selection = selectionWithout(firstListed + static_cast<vtkIdType>(listedCount),
    static_cast<vtkIdType>(added.size()), static_cast<vtkIdType>(converted.mesh.cellCount()));

  std::vector<EntityId> entities(converted.mesh.cellCount() + added.size());
  const auto next = std::copy(sides.entities.begin() + static_cast<std::ptrdiff_t>(facets.size()),
    sides.entities.end(), entities.begin() + firstListed);
  std::transform(unlisted.begin(), unlisted.end(), next, [&](Index f) { return ofFacets[f]; });
  MeshArrays arrays = select(state.arrays, result.selection);
  writeAttributes(context.model, entities, arrays.ofCells);

  append(converted.cellIds[dimension], newIds(context.exchange, state.mesh, added));
  append(listed, added);
  if (converted.midNodes)
  {
    EdgeTable& table = converted.midNodes->table;
    std::transform(added.begin(), added.end(), std::back_inserter(table.*edges),
      [&](const auto& cell) { return edgesOf(table, cell); });
  }
  std::swap(state.arrays, arrays);
  result.mesh = makeDataSet(state);
  std::swap(state.arrays, arrays);
  converted.cellIds[dimension].resize(listedCount);
  listed.resize(listedCount);
  if (converted.midNodes)
  {
    (converted.midNodes->table.*edges).resize(listedCount);
  }
  return result;
}

/// The same of a mesh of triangles in space.
MeshWithBoundary makeWithFaces(
  const PipelineContext& context, MeshState& state, const std::vector<EntityId>& ofFacets)
{
  const SimplexMesh& mesh = state.mesh.mesh();
  std::vector<EntityId> entities(mesh.cellCount());
  for (std::size_t f = 0; f < ofFacets.size(); ++f)
  {
    const Index triangle = state.boundary->boundary.facets[f].cell;
    entities[firstCellOfDimension(mesh, 2) + triangle] = ofFacets[f];
  }
  MeshWithBoundary result{ makeDataSet(state), {} };
  writeAttributes(context.model, entities, result.mesh->GetCellData());
  return result;
}

} // namespace

MeshState boundaryMesh(
  const PipelineContext& context, MeshState state, const std::vector<std::string>& faces)
{
  const SimplexMesh& mesh = state.mesh.mesh();
  checkForBoundary(mesh);
  const ClassifiedFacets chosen = facetsAmong(context, state, faces);
  const std::vector<Index> vertices = verticesOf(chosen, mesh.points.size());

  MeshState result;
  result.parallelFor = state.parallelFor;
  result.prototype = state.prototype;
  result.mesh.converted.mesh = facetsAsCells(mesh, chosen, vertices);
  result.mesh.shared = findShared(context.exchange, result.mesh.mesh());
  result.mesh.vertexIdBound = state.mesh.vertexIdBound;
  numberCells(context.exchange, result.mesh);
  const Classification& from = *state.classification;
  Classification& places = result.classification.emplace();
  places.entities = taken(from.entities, vertices);
  places.parameters = taken(from.parameters, vertices);
  places.distances = taken(from.distances, vertices);

  ArraySelection selection;
  selection.points.emplace(vertices.begin(), vertices.end());
  const vtkIdType first = firstCellOfDimension(mesh, mesh.dimension);
  std::transform(chosen.facets.begin(), chosen.facets.end(),
    std::back_inserter(selection.cells.emplace()),
    [&](const Facet& facet) { return first + facet.cell; });
  result.arrays = select(state.arrays, selection);
  result.mapping = std::move(state.mapping);
  result.mapping.convert(std::move(selection));
  writeAttributes(context.model, chosen.entities, result.arrays.ofCells);
  result.arrays.ofCells->SetActiveScalars(arrays::entity);
  return result;
}

MeshWithBoundary makeDataSetWithBoundary(const PipelineContext& context, MeshState& state)
{
  SimplexMesh& mesh = state.mesh.mesh();
  checkForBoundary(mesh);
  const std::vector<EntityId> ofFacets = entitiesOfFacets(context, state);
  const DistributedBoundary& boundary = state.boundary->boundary;
  if (boundary.ofSurface)
  {
    return makeWithFaces(context, state, ofFacets);
  }
  return boundary.kind == BoundaryKind::Triangles
           ? makeWithFacets(context, state, ofFacets, mesh.triangles, &EdgeTable::ofTriangles)
           : makeWithFacets(context, state, ofFacets, mesh.segments, &EdgeTable::ofSegments);
}

} // namespace cadrefine
