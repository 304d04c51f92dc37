// Densities of cells whose volumes change by a motion of vertices.
#pragma once

#include <cadrefine/base/WeightedRows.h>
#include <cadrefine/mesh/Mesh.h>
#include <cadrefine/quadratic/MidNodes.h>
#include <cadrefine/refinement/RefinementTrace.h>

#include <vector>

namespace cadrefine
{

/// Rows for the densities of cells whose vertices moved: cells of the mesh's own dimension take
/// along what they hold, so that their densities change by the old volume (in 2D, area) over the
/// new one. `before`: the vertices' old places. A row for each cell with another volume than
/// before, by its place in the order of makePointSet. Cells that are flat now keep their densities;
/// what inverted ones held counts as if they were not.
WeightedRows densitiesOfMoved(const Mesh& mesh, const std::vector<Point3>& before);

/// Volumes (in 2D, areas) of the cells of the mesh's own dimension, with its vertices at these
/// points.
std::vector<double> sizesOfCells(const Mesh& mesh, const std::vector<Point3>& points);

/// Rows as of densitiesOfMoved for the cells of a refined mesh, from their parents: these were cut
/// straight, then vertices moved. `before`: the places of the vertices that there were before the
/// cut. With `parentSizes` (see sizesOfCells) children together hold what their parent held, also
/// where triangles replace a quadrilateral that is not plane; empty: there is no such cell, all are
/// simplices.
WeightedRows densitiesOfRefined(const Mesh& mesh, const RefinementTrace& trace,
  std::vector<Point3> before, const std::vector<double>& parentSizes);

/// Rows as of densitiesOfMoved for cells that were straight and are of second order now: their
/// volumes are integrals of polynomials (see jacobianOf), and exact. `plane` is the unit normal of
/// a planar mesh; on surfaces in space, where areas are no such integrals, there are no rows.
WeightedRows densitiesOfCurved(const Mesh& mesh, const MidNodes& nodes, const Vector3& plane);

} // namespace cadrefine
