#include "pipeline/BoundaryMesh.h"

#include "comm/SharedEdges.h"
#include "fields/CADArrays.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/base/SortUniquely.h>

#include <vtkCellData.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace cadrefine
{
namespace
{

/// Facets of this dimension, and what they lie on.
struct ClassifiedFacets
{
  int dimension = 2;
  std::vector<Facet> facets;
  std::vector<EntityId> entities;
};

/// The vertices that facets use, ascending.
std::vector<Index> verticesOf(const ClassifiedFacets& chosen, std::size_t vertexCount)
{
  std::vector<unsigned char> used(vertexCount, 0);
  for (const Facet& facet : chosen.facets)
  {
    for (const Index vertex : facet)
    {
      used[vertex] = 1;
    }
  }
  return indicesWhere(vertexCount, [&](std::size_t v) { return used[v] != 0; });
}

/// Appends a facet to the cells of its shape.
void addCell(Mesh& mesh, const Facet& facet)
{
  visitShapes(mesh, facet.corners() > 2 ? 2 : 1,
    [&](auto, auto& cells)
    {
      auto& corners = cells.emplace_back();
      if (corners.size() == static_cast<std::size_t>(facet.corners()))
      {
        std::copy(facet.begin(), facet.end(), corners.begin());
      }
      else
      {
        cells.pop_back();
      }
    });
}

Mesh facetsAsCells(
  const Mesh& mesh, const ClassifiedFacets& chosen, const std::vector<Index>& vertices)
{
  Mesh result;
  std::vector<Index> placeOf(mesh.points.size(), -1);
  for (const Index vertex : vertices)
  {
    placeOf[vertex] = static_cast<Index>(result.points.size());
    result.points.push_back(mesh.points[vertex]);
    result.ids.push_back(mesh.ids[vertex]);
  }
  result.dimension = chosen.dimension;
  for (Facet facet : chosen.facets)
  {
    std::transform(
      facet.begin(), facet.end(), facet.vertices.begin(), [&](Index v) { return placeOf[v]; });
    addCell(result, facet);
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

/// The facets of the boundary on these faces, or all where none are named, in the order in which
/// cells are numbered: triangles first. Throws Error where there are none on these faces.
/// Collective.
ClassifiedFacets facetsAmong(
  const PipelineContext& context, MeshState& state, const std::vector<std::string>& faces)
{
  const std::vector<EntityId> entities = entitiesOfFacets(context, state);
  const DistributedBoundary& boundary = state.boundary->boundary;
  std::vector<Index> chosen(entities.size());
  std::iota(chosen.begin(), chosen.end(), 0);
  if (!faces.empty())
  {
    const EntitySelection selection = selectFaces(context, state, faces);
    chosen = indicesWhere(entities.size(),
      [&](std::size_t f) { return selection.contains(context.model.nurbs(), entities[f]); });
    if (!context.exchange.any(!chosen.empty()))
    {
      throw Error("no boundary facet lies on the chosen faces (Faces)");
    }
  }
  std::stable_partition(chosen.begin(), chosen.end(),
    [&](Index facet) { return boundary.facets[facet].corners() < 4; });
  return { boundary.facetDimension(), taken(boundary.facets, chosen), taken(entities, chosen) };
}

void checkForBoundary(const Mesh& mesh)
{
  if (mesh.dimension == 0)
  {
    throw Error("the mesh has no cells of area or volume; points alone have no boundary");
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

/// Finds the entities of sides: facets know theirs, listed cells get those of their facets,
/// whichever rank these are on. Collective.
Sides compareWithListed(RankExchange& exchange, const DistributedMesh& mesh,
  const DistributedBoundary& boundary, const std::vector<EntityId>& ofFacets)
{
  std::vector<std::array<Index, 4>> keys;
  for (const Facet& facet : boundary.facets)
  {
    keys.push_back(facet.vertices);
  }
  visitShapes(mesh.mesh(), boundary.facetDimension(),
    [&](auto, const auto& cells)
    {
      for (const auto& cell : cells)
      {
        std::copy(cell.begin(), cell.end(), keys.emplace_back(Facet().vertices).begin());
      }
    });
  for (auto& key : keys)
  {
    std::sort(key.begin(), std::find(key.begin(), key.end(), -1));
  }
  auto distinct = keys;
  sortUniquely(distinct);
  std::vector<EntityId> entities(distinct.size());
  std::vector<unsigned char> isListed(distinct.size(), 0);
  std::vector<std::size_t> placeOf(keys.size());
  for (std::size_t k = 0; k < keys.size(); ++k)
  {
    placeOf[k] = std::lower_bound(distinct.begin(), distinct.end(), keys[k]) - distinct.begin();
    k < ofFacets.size() ? void(entities[placeOf[k]] = ofFacets[k]) : void(isListed[placeOf[k]] = 1);
  }
  const SharedItems shared = findSharedCells(exchange, mesh.shared, mesh.mesh().ids, distinct);
  combineLargest(exchange, shared, entities);
  combineLargest(exchange, shared, isListed);
  return { taken(entities, placeOf), taken(isListed, placeOf) };
}

/// Global ids for facets, after those of all cells of the mesh.
std::vector<GlobalId> newIds(
  RankExchange& exchange, const DistributedMesh& mesh, const std::vector<Facet>& facets)
{
  GlobalId first = 0;
  for (const auto& ids : mesh.converted.cellIds)
  {
    first = std::accumulate(ids.begin(), ids.end(), first,
      [](GlobalId bound, GlobalId id) { return std::max(bound, id + 1); });
  }
  first = exchange.max(first);
  std::vector<GlobalId> ids = numberFacets(exchange, mesh, facets);
  std::transform(ids.begin(), ids.end(), ids.begin(), [&](GlobalId id) { return first + id; });
  return ids;
}

/// The facet, turned so that it begins at its smallest id, as VTK has the sides of cells when it
/// draws them: both are drawn alike, then, and colours are those of the cells.
Facet fromSmallestId(Facet facet, const std::vector<GlobalId>& ids)
{
  Index* first = facet.vertices.data();
  Index* last = first + facet.corners();
  std::rotate(
    first, std::min_element(first, last, [&](Index a, Index b) { return ids[a] < ids[b]; }), last);
  return facet;
}

/// Appends facets to the cells of their shape, and the edges of these to the table of mid nodes.
template<class Shape>
void addFacets(Shape shape, ConvertedMesh& converted, const std::vector<Facet>& facets)
{
  for (const Facet& facet : facets)
  {
    auto& cell = (converted.mesh.*Shape::cells).emplace_back();
    std::copy(facet.begin(), facet.end(), cell.begin());
    if (converted.midNodes)
    {
      EdgeTable& table = converted.midNodes->table;
      auto& edges = (table.*edgesOfCells(shape)).emplace_back();
      std::transform(std::begin(Shape::edges), std::end(Shape::edges), edges.begin(),
        [&](const auto& ends) { return table.find(cell[ends[0]], cell[ends[1]]); });
    }
  }
}

template<class Shape>
void removeLast(Shape shape, ConvertedMesh& converted, std::size_t count)
{
  auto& cells = converted.mesh.*Shape::cells;
  cells.resize(cells.size() - count);
  if (converted.midNodes)
  {
    (converted.midNodes->table.*edgesOfCells(shape)).resize(cells.size());
  }
}

/// Does makeDataSetWithBoundary where facets are sides of cells. `Shapes` are those of facets.
template<class... Shapes>
MeshWithBoundary makeWithFacets(const PipelineContext& context, MeshState& state,
  const std::vector<EntityId>& ofFacets, Shapes... shapes)
{
  ConvertedMesh& converted = state.mesh.converted;
  const DistributedBoundary& boundary = state.boundary->boundary;
  const Sides sides = compareWithListed(context.exchange, state.mesh, boundary, ofFacets);
  const int dimension = boundary.facetDimension();
  std::vector<Facet> added;
  std::vector<EntityId> ofAdded;
  const auto choose = [&](auto shape)
  {
    const std::size_t begun = added.size();
    for (std::size_t f = 0; f < ofFacets.size(); ++f)
    {
      const Facet& facet = boundary.facets[f];
      if (!sides.listed[f] && static_cast<std::size_t>(facet.corners()) == decltype(shape)::corners)
      {
        added.push_back(fromSmallestId(facet, converted.mesh.ids));
        ofAdded.push_back(ofFacets[f]);
      }
    }
    return added.size() - begun;
  };
  const std::size_t counts[] = { choose(shapes)... };
  const auto idsOfAdded = newIds(context.exchange, state.mesh, added);

  const vtkIdType first = firstCellOfDimension(converted.mesh, dimension);
  const auto idsBefore = converted.cellIds[dimension];
  std::vector<GlobalId> ids;
  std::vector<EntityId> entities(first);
  std::vector<vtkIdType> selection(first);
  std::iota(selection.begin(), selection.end(), 0);
  std::size_t listed = 0;
  std::size_t place = 0; // among the added ones
  const auto insert = [&](auto shape, std::size_t count)
  {
    const std::size_t end = listed + (converted.mesh.*decltype(shape)::cells).size();
    for (; listed < end; ++listed)
    {
      entities.push_back(sides.entities[ofFacets.size() + listed]);
      selection.push_back(first + static_cast<vtkIdType>(listed));
      ids.push_back(idsBefore[listed]);
    }
    const auto begin = static_cast<std::ptrdiff_t>(place);
    place += count;
    const auto last = static_cast<std::ptrdiff_t>(place);
    entities.insert(entities.end(), ofAdded.begin() + begin, ofAdded.begin() + last);
    selection.insert(selection.end(), count, noTuple);
    ids.insert(ids.end(), idsOfAdded.begin() + begin, idsOfAdded.begin() + last);
    addFacets(shape, converted, { added.begin() + begin, added.begin() + last });
  };
  const std::size_t* count = counts;
  (insert(shapes, *count++), ...);
  entities.resize(converted.mesh.cellCount());
  for (vtkIdType cell = first + static_cast<vtkIdType>(listed); selection.size() < entities.size();
       ++cell)
  {
    selection.push_back(cell);
  }

  MeshWithBoundary result;
  result.selection.cells = std::move(selection);
  MeshArrays arrays = select(state.arrays, result.selection);
  writeAttributes(context.model, entities, arrays.ofCells);
  converted.cellIds[dimension] = std::move(ids);
  std::swap(state.arrays, arrays);
  result.mesh = makeDataSet(state);
  std::swap(state.arrays, arrays);
  converted.cellIds[dimension] = idsBefore;
  count = counts;
  (removeLast(shapes, converted, *count++), ...);
  return result;
}

/// Does makeDataSetWithBoundary for a mesh of triangles in space, whose facets are its cells.
MeshWithBoundary makeWithFaces(
  const PipelineContext& context, MeshState& state, const std::vector<EntityId>& ofFacets)
{
  const Mesh& mesh = state.mesh.mesh();
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
  const Mesh& mesh = state.mesh.mesh();
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
  checkForBoundary(state.mesh.mesh());
  const std::vector<EntityId> ofFacets = entitiesOfFacets(context, state);
  const DistributedBoundary& boundary = state.boundary->boundary;
  if (boundary.ofSurface)
  {
    return makeWithFaces(context, state, ofFacets);
  }
  return boundary.kind == BoundaryKind::Faces
           ? makeWithFacets(context, state, ofFacets, shapes::Triangle{}, shapes::Quadrilateral{})
           : makeWithFacets(context, state, ofFacets, shapes::Segment{});
}

} // namespace cadrefine
