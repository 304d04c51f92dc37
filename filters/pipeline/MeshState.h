// A mesh on its way through the steps of a filter.
#pragma once

#include "classification/BoundaryCache.h"
#include "classification/DistributedBoundary.h"
#include "fields/ArrayTransfer.h"
#include "fields/FieldMapping.h"
#include "mesh/DistributedMesh.h"
#include "pipeline/PipelineContext.h"
#include "pipeline/PipelineResult.h"
#include "refinement/DistributedRefinement.h"

#include <cadrefine/cad/model/EntitySelection.h>
#include <cadrefine/mesh/QualitySummary.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cadrefine
{

/// What the steps change: data sets are made of it only where it leaves the filter. It must stay at
/// its place in memory while it has a boundary, which refers to the mesh.
struct MeshState
{
  DistributedMesh mesh;
  /// Its arrays, with what is found of the mesh; without ids and those of `classification`.
  MeshArrays arrays;
  /// Places on the CAD, of mid nodes after those of the vertices.
  std::optional<Classification> classification;
  FieldMapping mapping;                   ///< The way of arrays from the input.
  vtkSmartPointer<vtkPointSet> prototype; ///< An empty data set, of the class of the input.
  ParallelFor parallelFor = serialFor;    ///< Loops on this rank's threads.
  /// Boundary and quality of the mesh as it is, where they have been looked for.
  std::unique_ptr<ClassifiedBoundary> boundary = nullptr;
  std::optional<QualitySummary> quality = std::nullopt;
  /// 1 for vertices on the boundary; empty: not known.
  std::vector<unsigned char> onBoundary = {};
  /// Tags that do not tell kinds of cells apart, as the mesh came; none: not looked at.
  std::optional<std::vector<std::uint64_t>> numberings = std::nullopt;
  bool remembers = false; ///< Keep what is measured for the boundary after the next step.
  BoundaryCache cache = {};
};

/// Reads the mesh and its arrays, not the classification. Collective; see makeDistributedMesh.
MeshState readMesh(RankExchange& exchange, vtkPointSet* input, CellOrder order = CellOrder::First);

/// Reads the classification of the input that the mesh was read from. Throws Error on all ranks;
/// collective.
void readClassification(const PipelineContext& context, vtkPointSet* input, MeshState& state);

/// Gives the vertices their places on the CAD, instead of those of the input.
void setClassification(MeshState& state, Classification classification);

/// The boundary of the classified mesh. Collective.
ClassifiedBoundary& boundaryOf(const PipelineContext& context, MeshState& state);

/// For each vertex 1 if it is on the boundary; found with boundaryOf, unless it is known.
/// Collective.
const std::vector<unsigned char>& onBoundaryOf(const PipelineContext& context, MeshState& state);

/// For each facet of the boundary the CAD face, of a planar mesh the CAD edge, that it lies on;
/// none off the CAD. Collective. Work: a query for a facet that spans several faces; for a planar
/// mesh that of findMidpoints, once for a boundary.
std::vector<EntityId> entitiesOfFacets(const PipelineContext& context, MeshState& state);

/// The CAD's faces that are named, of a planar mesh its edges; see selectEntities. Collective.
EntitySelection selectFaces(
  const PipelineContext& context, MeshState& state, const std::vector<std::string>& faces);

/// For each facet of the boundary 1 if it is on these faces (see selectEntities); empty if no faces
/// are given. Collective. Work: that of entitiesOfFacets.
std::vector<unsigned char> facetsOn(
  const PipelineContext& context, MeshState& state, const std::vector<std::string>& faces);

/// Validity and quality of all cells, over all ranks. Collective.
const QualitySummary& qualityOf(RankExchange& exchange, MeshState& state);

/// What to tell the user of invalid cells, which vertices that move are to mend; told on rank 0.
/// Returns whether there are any. Throws Error where more than half of the cells are invalid.
/// Collective.
bool warnOfInvalidCells(const PipelineContext& context, MeshState& state);

/// Takes the arrays along the stages of the mapping that follow its first `done` ones.
void followMapping(RankExchange& exchange, MeshState& state, std::size_t done);

/// Takes the arrays along a motion of vertices: those inside the mesh get the values of their
/// new places (see interpolationOf), and cells take along what they hold. Collective.
void followMotion(RankExchange& exchange, MeshState& state, const MotionTrace& motion);

/// Forgets what was found of the mesh as it was.
void meshHasChanged(MeshState& state);

/// Sends the cells to these ranks (see Redistribution.h), with what they and their vertices have;
/// if given, with these values of the cells. Collective.
void redistribute(const PipelineContext& context, MeshState& state, const std::vector<int>& ranks,
  std::vector<std::int64_t>* ofCells = nullptr);

/// Cuts the mesh as planned (see refineOntoCAD; for a mesh that is not classified, refine), and its
/// arrays with it. Returns how many points were projected. Collective.
std::int64_t cut(const PipelineContext& context, MeshState& state, const RefinementPlan& plan,
  NewVertices newVertices);

/// The mesh as a data set with all arrays.
vtkSmartPointer<vtkPointSet> makeDataSet(const MeshState& state);

/// The result of a filter that ends with this state.
PipelineResult resultOf(MeshState state);

} // namespace cadrefine
