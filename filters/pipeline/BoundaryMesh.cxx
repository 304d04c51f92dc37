#include "pipeline/BoundaryMesh.h"

#include "classification/EdgeMidpoints.h"
#include "comm/CollectiveErrors.h"
#include "fields/CADArrays.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/nurbs/NurbsModel.h>

#include <vtkCellData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkSignedCharArray.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <utility>

namespace cadrefine
{
namespace
{

/// The face of a triangle on the CAD.
EntityId faceOf(const BoundaryProjector& projector, const ClassifiedFacet& facet, int common)
{
  if (common >= 0)
  {
    return { 2, common };
  }
  const auto& p = facet.points;
  const ClosestPoint nearest =
    projector.nearest((1.0 / 3) * (p[0] + p[1] + p[2]), std::numeric_limits<double>::infinity());
  return { 2, firstFaceAt(projector.model().nurbs(), nearest.entity) };
}

/// The CAD edge of a segment whose middle belongs there.
EntityId edgeOf(const CADModel& model, const ClosestPoint& middle)
{
  if (middle.entity && middle.entity.dimension == 0)
  {
    const auto& edges = model.nurbs().vertices[middle.entity.index].edges;
    return edges.empty() ? EntityId{} : EntityId{ 1, edges.front() };
  }
  return middle.entity;
}

/// For each facet the face or edge that it lies on.
std::vector<EntityId> entitiesOf(const PipelineContext& context, MeshState& state)
{
  ClassifiedBoundary& classified = boundaryOf(context, state);
  const DistributedBoundary& boundary = classified.boundary;
  const SimplexMesh& mesh = state.mesh.mesh();
  const bool triangles = boundary.kind == BoundaryKind::Triangles;
  if (!triangles && !classified.midpoints)
  {
    findMidpoints(context.exchange, mesh, *state.classification, state.cache, classified);
  }
  std::vector<EntityId> entities(boundary.facets.size());
  const auto find = [&](std::size_t f)
  {
    const FacetRecord& record = classified.classes.facets[f];
    if (record.onCAD && triangles)
    {
      entities[f] = faceOf(classified.projector,
        classifiedFacet(mesh, state.classification->entities, boundary.facets[f], boundary.kind),
        record.face);
    }
    else if (record.onCAD)
    {
      entities[f] = edgeOf(context.model, (*classified.midpoints)[boundary.facetEdges[f][0]]);
    }
  };
  agreeOnFailure(
    context.exchange, [&] { forEachIndex(state.parallelFor, entities.size(), coarseGrain, find); });
  return entities;
}

/// The vertices that facets use, ascending.
std::vector<Index> verticesOf(const DistributedBoundary& boundary, std::size_t vertexCount)
{
  std::vector<unsigned char> used(vertexCount, 0);
  for (const Facet& facet : boundary.facets)
  {
    for (int k = 0; k < boundary.facetCorners(); ++k)
    {
      used[facet.vertices[k]] = 1;
    }
  }
  std::vector<Index> vertices;
  for (std::size_t v = 0; v < vertexCount; ++v)
  {
    if (used[v])
    {
      vertices.push_back(static_cast<Index>(v));
    }
  }
  return vertices;
}

SimplexMesh facetsAsCells(
  const SimplexMesh& mesh, const DistributedBoundary& boundary, const std::vector<Index>& vertices)
{
  SimplexMesh result;
  std::vector<Index> placeOf(mesh.points.size(), -1);
  for (const Index vertex : vertices)
  {
    placeOf[vertex] = static_cast<Index>(result.points.size());
    result.points.push_back(mesh.points[vertex]);
    result.ids.push_back(mesh.ids[vertex]);
  }
  result.dimension = boundary.facetCorners() - 1;
  for (const Facet& facet : boundary.facets)
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

template<class Value>
std::vector<Value> taken(const std::vector<Value>& values, const std::vector<Index>& places)
{
  std::vector<Value> result;
  result.reserve(places.size());
  std::transform(places.begin(), places.end(), std::back_inserter(result),
    [&](Index place) { return values[place]; });
  return result;
}

void addEntities(const CADModel& model, const std::vector<EntityId>& entities, vtkCellData& ofCells)
{
  const auto count = static_cast<vtkIdType>(entities.size());
  vtkNew<vtkSignedCharArray> dimensions;
  dimensions->SetName(arrays::dimension);
  vtkNew<vtkIntArray> indices;
  indices->SetName(arrays::entity);
  vtkNew<vtkStringArray> names;
  names->SetName(arrays::name);
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetName(arrays::colour);
  colours->SetNumberOfComponents(3);
  for (const auto& array :
    std::initializer_list<vtkAbstractArray*>{ dimensions, indices, names, colours })
  {
    array->SetNumberOfTuples(count);
    ofCells.AddArray(array);
  }
  for (vtkIdType c = 0; c < count; ++c)
  {
    const EntityId entity = entities[c];
    const EntityAttributes attributes = entity ? model.attributes(entity) : EntityAttributes();
    dimensions->SetValue(c, entity.dimension);
    indices->SetValue(c, entity.index);
    names->SetValue(c, attributes.name);
    colours->SetTypedTuple(c, colourOf(attributes).data());
  }
  ofCells.SetActiveScalars(arrays::entity);
}

} // namespace

MeshState boundaryMesh(const PipelineContext& context, MeshState state)
{
  const SimplexMesh& mesh = state.mesh.mesh();
  if (mesh.dimension == 0)
  {
    throw Error("the mesh has no triangles or tetrahedra; points alone have no boundary");
  }
  const std::vector<EntityId> entities = entitiesOf(context, state);
  const DistributedBoundary& boundary = state.boundary->boundary;
  const std::vector<Index> vertices = verticesOf(boundary, mesh.points.size());

  MeshState result;
  result.parallelFor = state.parallelFor;
  result.prototype = state.prototype;
  result.mesh.converted.mesh = facetsAsCells(mesh, boundary, vertices);
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
  std::transform(boundary.facets.begin(), boundary.facets.end(),
    std::back_inserter(selection.cells.emplace()),
    [&](const Facet& facet) { return first + facet.cell; });
  result.arrays = select(state.arrays, selection);
  result.mapping = std::move(state.mapping);
  result.mapping.convert(std::move(selection));
  addEntities(context.model, entities, *result.arrays.ofCells);
  return result;
}

} // namespace cadrefine
