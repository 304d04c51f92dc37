// Conversion between VTK's data sets and the core's meshes.
#pragma once

#include "comm/RankExchange.h"

#include <cadrefine/base/ParallelFor.h>
#include <cadrefine/mesh/Mesh.h>
#include <cadrefine/quadratic/MidNodes.h>

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <array>
#include <optional>
#include <vector>

class vtkDataSetAttributes;
class vtkPointSet;

namespace cadrefine
{

/// A piece of a mesh, and where its vertices and cells come from in the data set it was made from.
struct ConvertedMesh
{
  Mesh mesh;
  /// The data set's point of each vertex, and after these of each mid node.
  std::vector<vtkIdType> pointOf;
  /// The data set's cell of each cell, by dimension; those of each shape are in the order of the
  /// data set.
  std::array<std::vector<vtkIdType>, 4> cellOf;
  /// Global ids of the cells, by dimension, in the same order; empty on all ranks if the data set
  /// has none on one.
  std::array<std::vector<GlobalId>, 4> cellIds;
  /// The mid nodes of a mesh of second order, on all ranks; none for one of first order.
  std::optional<MidNodes> midNodes;
};

/// Which cells a filter takes.
enum class CellOrder
{
  First,        ///< Cells with corners alone.
  FirstOrSecond ///< Also cells with mid nodes, if all cells of the mesh have these.
};

/// The wedge turned the other way: counter-clockwise where it was clockwise.
constexpr std::array<Index, 6> turned(const std::array<Index, 6>& wedge)
{
  return { wedge[3], wedge[4], wedge[5], wedge[0], wedge[1], wedge[2] };
}

/// For each edge of a turned wedge, its place in the wedge before.
constexpr int edgesOfTurned[9] = { 3, 4, 5, 0, 1, 2, 6, 7, 8 };

/// Reads cells of the shapes of Mesh.h from a vtkUnstructuredGrid or vtkPolyData on each rank.
/// Wedges may turn either way, but all the same. Cells that are marked as ghosts or hidden and
/// points that no cell uses are left out, marks of points do not count; points with the same global
/// id on a rank become one vertex. Vertices come in the order of the points. Ids come from the data
/// set's global ids if every rank has them, and otherwise from coordinates (vertices) and vertices
/// (cells): they then do not depend on the partition, and points that coincide are one vertex.
/// Collective. For cells of second order, the corners make the mesh; of their other points one for
/// each edge is taken, that of the first cell that has the edge.
///
/// Without cells, every point becomes a cell of dimension 0. The mesh's dimension is that of its
/// cells of highest dimension on any rank, and 0 for points alone.
///
/// Throws Error on all ranks for any other cell (named), for a mesh without points, for a mesh
/// whose cells are all left out, for a mesh of lines, for coordinates that are not finite or beyond
/// 2^170, for a cell that names a vertex twice, too few or too many points, or one that is not
/// there, for a global id that is none (see readGlobalIds) or that points at different places have,
/// for cells of both orders in one mesh, for cells of second order that do not meet in their mid
/// nodes.
ConvertedMesh convert(
  RankExchange& exchange, vtkPointSet* input, CellOrder order = CellOrder::First);

/// An empty data set of the class of `input` with the mesh's points (double precision) and cells,
/// those of lower dimension first. No arrays. With mid nodes, cells are of second order,
/// and the nodes' points follow those of the vertices; throws Error where `input` is vtkPolyData,
/// which has no such cells.
vtkSmartPointer<vtkPointSet> makePointSet(vtkPointSet* input, const Mesh& mesh,
  const std::optional<MidNodes>& midNodes = std::nullopt,
  const ParallelFor& parallelFor = serialFor);

/// Number of the first cell of this dimension in a data set made by makePointSet, which has the
/// cells of dimension 0 first, then 1, 2, 3.
vtkIdType firstCellOfDimension(const Mesh& mesh, int dimension);

} // namespace cadrefine
