// What tests of bad meshes have in common: all filters, on all ranks.
#pragma once

#include "FilterRun.h"
#include "ParallelTest.h"
#include "Partition.h"
#include "TestShapes.h"

#include <vtkAdaptToCAD.h>
#include <vtkUnstructuredGrid.h>

#include <functional>
#include <string>
#include <vector>

namespace cadrefine
{

/// A filter with a name, and how it is run.
struct NamedFilter
{
  const char* name;
  cadtest::Outcome (*attempt)(const cadtest::FilterRun& filters, vtkPointSet* mesh);
};

/// A test on all ranks, with a sphere of radius 2 as CAD.
class BadMesh : public ParallelTest
{
protected:
  using Grid = vtkSmartPointer<vtkUnstructuredGrid>;

  cadtest::TemporaryFolder folder;
  cadtest::FilterRun filters{ cadtest::writeInto(folder, cadtest::sphere(2), ".brep"),
    worldController() };

  /// All filters; those that read places on the CAD last.
  static const std::vector<NamedFilter>& allFilters();
  /// Project, Adapt and Mesh Validity, which read none.
  static std::vector<NamedFilter> filtersOfRawMeshes();
  /// Error, Refine, which do.
  static std::vector<NamedFilter> filtersOfProjectedMeshes();

  bool isLast() const { return exchange.rank() == exchange.size() - 1; }

  /// 20 tetrahedra in the sphere, boundary vertices somewhat off it.
  static Grid ball();
  /// This rank's piece of the mesh, its cells dealt out in blocks.
  vtkSmartPointer<vtkPointSet> pieceOf(vtkPointSet* whole) const;
  /// The same, for each rank all of the cells or none: they go to `rank`.
  vtkSmartPointer<vtkPointSet> allOn(int rank, vtkPointSet* whole) const;

  /// One error, on rank 0, that has this text, and no output on any rank.
  void expectError(const cadtest::Outcome& outcome, const std::string& text) const;
  void expectErrors(
    const std::vector<NamedFilter>& which, vtkPointSet* mesh, const std::string& text) const;

  /// A coordinate of a mesh of the last rank, of which point 5 is used, may be large, but not so
  /// that volumes overflow.
  void expectLimitOfCoordinates(const Grid& grid) const;

  /// The filters succeed on the pieces, which make the mesh that one rank makes of `whole`.
  void expectSame(const std::vector<NamedFilter>& which, vtkPointSet* piece, vtkPointSet* whole);
  /// That the pieces, put together, are this mesh.
  void expectSameMesh(vtkPointSet* piece, vtkPointSet* whole, const std::string& what);
};

} // namespace cadrefine
