// Checks of meshes of second order by sampling, with shape functions of their own.
#pragma once

#include <cadrefine/base/Vector3.h>

#include <array>
#include <functional>
#include <vector>

class vtkPointSet;

namespace cadtest
{

/// A quadratic triangle: corners, then the nodes of edges 01, 12, 20.
using CurvedFacet = std::array<cadrefine::Point3, 6>;

/// Quadratic triangles by which the quadratic tetrahedra of a data set meet the outside.
std::vector<CurvedFacet> outerFacets(vtkPointSet* data);

using ValueAt = std::function<double(const cadrefine::Point3&)>;

/// The largest value at the points of a lattice on the facets.
double largestOn(const std::vector<CurvedFacet>& facets, const ValueAt& valueAt);
/// The integral of the values over the facets, by many small triangles.
double integralOver(const std::vector<CurvedFacet>& facets, const ValueAt& valueAt);
/// Volume inside the facets of a closed surface, exactly.
double volumeInside(const std::vector<CurvedFacet>& facets);

/// Area of the quadratic triangles of a data set in the plane z = 0, exactly.
double areaOf(vtkPointSet* data);

/// The smallest determinant of the Jacobian, at points of a lattice, of the quadratic tetrahedra or
/// else (in the plane z = 0) triangles of a data set, divided by that of the straight cell.
double smallestJacobian(vtkPointSet* data);

} // namespace cadtest
