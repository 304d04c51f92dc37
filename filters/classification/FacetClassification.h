// Which facets of a mesh's boundary are on the CAD, and on which face.
#pragma once

#include "classification/ProjectionTask.h"

#include <functional>
#include <vector>

namespace cadrefine
{

struct FacetClasses
{
  std::vector<FacetRecord> records; ///< Records of this rank's facets.
  FaceSides sides;                  ///< Sides of the CAD's faces.
};

/// Classifies the facets, given the nearest point of each vertex:
///   1. a facet is on the CAD if all of its corners found a point, its normal fits there, and it
///      looks alike there; it is free if a corner is outside the user's region;
///   2. facets between two cells are not on the CAD if a corner is not there (see roundedDistance),
///      and outer facets are on the same face, or others are there while no corner of theirs is:
///      they are the end of a layer over it;
///   3. the outer facets that lie clearly on one face tell which way the CAD's normals point, seen
///      from the mesh (see decideSides); those of facets between two cells may point either way;
///   4. each triangle on the CAD finds its face (see FaceFinder);
///   5. those that are not sure of it take the face that most of their neighbours over smooth mesh
///      edges have.
/// Collective: two reductions, of three numbers for each CAD face, and an exchange of the
/// interface.
FacetClasses classifyFacets(const ProjectionTask& task, const std::vector<ClosestPoint>& hits);

/// The sides of the CAD's faces, by the votes of the outer facets on the CAD: whether the CAD's
/// normals point as theirs do at their corners inside faces (see decideSides). `placeOf` gives the
/// place of a vertex. Collective: a sum of two numbers for each CAD face.
FaceSides findSides(RankExchange& exchange, const CADModel& model,
  const DistributedBoundary& boundary, const std::vector<FacetRecord>& records,
  const std::function<ClosestPoint(Index)>& placeOf);

} // namespace cadrefine
