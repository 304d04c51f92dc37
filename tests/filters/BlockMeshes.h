// Coarse meshes of hexahedra, wedges, pyramids and quadrilaterals in curved shapes, and checks of
// cells of second order by VTK's own shape functions.
#pragma once

#include <vtkSmartPointer.h>

class vtkPointSet;
class vtkUnstructuredGrid;

namespace cadtest
{

using Grid = vtkSmartPointer<vtkUnstructuredGrid>;

/// Ball of a cube in six pyramids, and a hexahedron between each of its sides and the sphere.
/// Vertices lie off the sphere by up to 2% of the radius.
Grid ballWithPyramids(double radius);
/// The larger cube of that ball in six pyramids.
Grid cubeOfPyramids(double radius);
/// Cylinder round the z axis from 0 to `height`: wedges between a polygon's centre and its sides,
/// in `layers` layers. `documented`: turned as VTK's documentation draws them.
Grid cylinderOfWedges(double radius, double height, int corners, int layers, bool documented);
/// Disc in the plane z = 0: a square of four quadrilaterals and eight round it.
Grid discOfQuadrilaterals(double radius);
/// The six outer sides of that ball.
Grid sphereOfQuadrilaterals(double radius);

/// The smallest determinant of the Jacobian on a lattice of points in the cells of highest
/// dimension; of a mesh of area its component along z. `documented`: of what turns the other way.
double smallestSample(vtkPointSet* data, bool documented);
/// The volume of cells of volume, or the area of quadrilaterals in the plane z = 0, exactly; given
/// a cell array, its integral over them.
double sizeOf(vtkPointSet* data, const char* density = nullptr);

} // namespace cadtest
