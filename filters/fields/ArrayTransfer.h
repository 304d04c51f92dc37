// Carrying a mesh's own arrays over to the mesh made from it.
#pragma once

#include "mesh/PointSetConversion.h"

#include <cadrefine/base/ParallelFor.h>
#include <cadrefine/refinement/RefinementTrace.h>

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>

#include <optional>
#include <string>
#include <vector>

class vtkAbstractArray;
class vtkDataArray;
class vtkDataSetAttributes;
class vtkPointSet;

namespace cadrefine
{

/// The arrays of a mesh: a tuple for each vertex, or for each cell in the order of makePointSet.
/// Ghost arrays and ids are left out; the names of the ids are kept.
struct MeshArrays
{
  vtkSmartPointer<vtkPointData> ofVertices;
  vtkSmartPointer<vtkCellData> ofCells;
  vtkSmartPointer<vtkFieldData> ofMesh;
  std::string vertexIdName;
  std::string cellIdName;
};

/// An array of the same type, name and components as `array`, with `count` tuples of any value.
vtkSmartPointer<vtkAbstractArray> emptyLike(vtkAbstractArray* array, vtkIdType count);

/// The array in `other` that the one at `index` in `attributes` is there: of the same name or,
/// among those without names, in the same place, and of the same type and number of components.
/// Null where there is none.
vtkAbstractArray* arrayLike(
  vtkDataSetAttributes* attributes, int index, vtkDataSetAttributes* other);

/// Copies the tuples of `from` at `places`, of which those from `begin` to `end` count, to `to`, an
/// array of the same type: each to where its place stands in the list. See noTuple.
void copyTuples(vtkAbstractArray* from, const std::vector<vtkIdType>& places, std::size_t begin,
  std::size_t end, vtkAbstractArray* to);

/// Adds the array to `target` as this attribute (VTK's scalars, vectors, ...; -1: as none).
void addAs(int attribute, vtkAbstractArray* array, vtkDataSetAttributes* target);

/// The arrays of a data set, shared with it; cell arrays where it has cells.
MeshArrays arraysOf(vtkPointSet* input);

/// Tuples to take, in this order; none: all of them as they are.
using Places = std::optional<std::vector<vtkIdType>>;
/// Stands for the place of a tuple that was not there: a new one is made, of zeros or empty
/// strings.
constexpr vtkIdType noTuple = -1;

struct ArraySelection
{
  Places points;
  Places cells;
};

/// Where the vertices and cells of `mesh`, which was converted from `input`, have their tuples.
ArraySelection selectionOf(vtkPointSet* input, const ConvertedMesh& mesh);

/// The arrays with the selected tuples; arrays of which all is taken are shared.
MeshArrays select(const MeshArrays& arrays, const ArraySelection& selection);

/// The arrays of the mesh that became of `coarse`: cell arrays are inherited, point arrays
/// interpolated to the middle of the edge, whose ends may be vertices that came before it. Arrays
/// of floating point follow the rows of the trace where there is one, the cell arrays of the names
/// in `densities` those for densities. Sums are in double precision, and but for densities between
/// the smallest and the largest value. What is measured (see isMeasured) is inherited. Arrays of
/// whole numbers or other types keep a value that both ends have, and otherwise take that of the
/// end with the smaller global id (tags must not be averaged). Work: linear in the values made, in
/// their own type.
MeshArrays refineArrays(const MeshArrays& coarse, const RefinementTrace& trace,
  const std::vector<std::string>& densities = {});

/// The arrays as they are, except that point arrays of floating point get the sums of the rows,
/// within the values summed up.
MeshArrays withVertexRows(const MeshArrays& arrays, const WeightedRows& rows);

/// The arrays as they are, except that cell arrays of these names, if they are of floating point,
/// get the sums of the rows.
MeshArrays withDensities(
  const MeshArrays& arrays, const WeightedRows& rows, const std::vector<std::string>& densities);

/// The arrays with tuples for mid nodes after those of the vertices, interpolated as in
/// refineArrays.
MeshArrays withMidNodes(
  const MeshArrays& arrays, const std::vector<std::array<Index, 2>>& parentEdges);

/// Adds the arrays, and the global ids of `mesh`, to `output`, which was made from it.
void setArrays(const MeshArrays& arrays, const ConvertedMesh& mesh, vtkPointSet* output,
  const ParallelFor& parallelFor = serialFor);

} // namespace cadrefine
