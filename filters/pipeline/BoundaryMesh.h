// The boundary of a mesh as cells.
#pragma once

#include "pipeline/MeshState.h"
#include "pipeline/PipelineContext.h"

#include <string>
#include <vector>

namespace cadrefine
{

/// The boundary of a classified mesh (see findBoundary) as a mesh of its own: triangles, or the
/// segments of a planar mesh, with the vertices that they use. Vertices keep their ids; facets have
/// ids by those of their vertices. Cell arrays are those of the cell that a facet is a side of, and
/// CADDimension, CADEntity (the face, or of a segment the edge, that it lies on; -1 where it does
/// not lie on the CAD), CADName and CADColor of that. A facet that spans several faces is given the
/// one nearest to its centroid. In a mesh of second order, facets have only corners. With `faces`
/// (see selectFaces) the facets on these alone; throws Error where there are none.
///
/// Collective. Work: that of classifying the boundary, and in the plane one projection a segment.
MeshState boundaryMesh(
  const PipelineContext& context, MeshState state, const std::vector<std::string>& faces);

/// A data set with cells that the mesh does not have.
struct MeshWithBoundary
{
  vtkSmartPointer<vtkPointSet> mesh;
  ArraySelection selection; ///< What leads from the mesh to the data set.
};

/// The mesh as a data set (see makeDataSet), with the facets of its boundary (see findBoundary)
/// that are not listed as cells already. The cell arrays of boundaryMesh tell the CAD face or edge
/// of all facets, listed ones too; other cells have none: -1, no name, white. For a mesh of
/// triangles in space, whose facets are its cells, only the arrays are added. Other cell arrays are
/// 0 on added cells: no tag, no error. Ids of these come after those of the other cells, by those
/// of their vertices. In a mesh of second order, they have mid nodes too. The mesh is classified,
/// and stays as it is.
///
/// Collective. Work: that of boundaryMesh, of sorting the facets, and of makeDataSet; messages as
/// findSharedCells.
MeshWithBoundary makeDataSetWithBoundary(const PipelineContext& context, MeshState& state);

} // namespace cadrefine
