// Between the tests' meshes and VTK's data sets.
#pragma once

#include <cadrefine/mesh/Mesh.h>

#include <vtkSmartPointer.h>

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

class vtkDataObject;
class vtkPointSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace cadtest
{

/// All cells of the mesh, those of lower dimensions first. No arrays.
vtkSmartPointer<vtkUnstructuredGrid> toGrid(const cadrefine::Mesh& mesh);
/// The triangles and quadrilaterals of the mesh. No arrays.
vtkSmartPointer<vtkPolyData> toPolyData(const cadrefine::Mesh& mesh);
/// Points and cells of a data set (of cells of second order the corners); the points' numbers are
/// the ids. Wedges are turned if most of them are as VTK's documentation draws them.
cadrefine::Mesh toMesh(vtkPointSet* dataSet);

/// Reads a .vtu file; throws where it cannot be read or is empty.
vtkSmartPointer<vtkUnstructuredGrid> readGrid(const std::string& path);

/// Names of the field arrays that only one of them has, or that are not the same, bit for bit.
std::vector<std::string> differentFields(vtkPointSet* found, vtkPointSet* expected);

/// The only value of a field array; throws where there is none.
double fieldValue(vtkPointSet* dataSet, const char* name);

/// The columns of numbers of a vtkTable, by name; throws where it is none.
std::map<std::string, std::vector<double>> columnsOf(vtkDataObject* table);

/// Same points, cells and arrays, in the same order, bit for bit.
testing::AssertionResult areSame(vtkPointSet* a, vtkPointSet* b);

/// Adds arrays that tell whether they were carried over: Linear (point, double: a linear function
/// of the coordinates), Region (point, int), Tag (cell, int: the number of the cell), Colour (cell,
/// three floats).
void addArrays(vtkPointSet* dataSet);
/// The linear function.
double linearAt(const double point[3]);

/// Adds a cell array of this name: the largest x of each cell.
void addLargestX(vtkPointSet* dataSet, const char* name);

/// Sets global ids of points and cells, in an order that is not that of the points and cells.
void addGlobalIds(vtkPointSet* dataSet);

/// A ball of radius 2, coarse, with its boundary triangles, a line and two vertices as tags.
vtkSmartPointer<vtkPointSet> taggedBall();

} // namespace cadtest
