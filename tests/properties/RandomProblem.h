// Random meshes near random CAD, and random work on them.
#pragma once

#include "FilterRun.h"
#include "RandomShapes.h"

#include <cadrefine/mesh/Mesh.h>

#include <TopoDS_Shape.hxx>

#include <vector>

namespace propertytest
{

/// A mesh, some 1 in size, whose boundary is near the CAD. Vertices are moved at random, so that no
/// two edges are equally long but by design of the kind.
struct FilterProblem
{
  explicit FilterProblem(Random& random);
  /// Of hexahedra, wedges, pyramids and quadrilaterals, among simplices or not; often with listed
  /// boundary. Wedges may be in the order of VTK's documentation.
  static FilterProblem mixed(Random& random);

  cadrefine::Mesh mesh;
  TopoDS_Shape shape;
  bool isSurface = false; ///< Cells of area in space.
  bool isBoundaryListed = false;

  /// A data set with arrays.
  vtkSmartPointer<vtkPointSet> dataSet() const;

private:
  FilterProblem() = default;
};

/// Which filters run, and with which settings. Lengths are relative to a problem of size 1.
struct Plan
{
  explicit Plan(Random& random, const FilterProblem& problem);

  int depth = 1;
  bool isBulk = false;
  double fraction = 0.5;
  double threshold = 0;
  int levels = 1;
  bool cutFacets = false;
  bool balance = true;
  double minimumQuality = 0.1; ///< In refinement.
  int operations = vtkRefineWithCAD::ALL_OPERATIONS;
  double chordTolerance = 0;
  double normalAngle = 0;
  bool straight = false;
  bool uniformAfterwards = false;
  bool isQuadratic = false;
  bool keepLayers = true;
  int coarseningLevels = 0;   ///< After refinement.
  double coarseningError = 0; ///< Of the error before that, the part that coarsening may leave.
  int dimension = 3;

  using Steps = std::vector<cadtest::FilterRun::Data>;

  /// The mesh after each filter: projected, measured, refined, perhaps coarsened, perhaps
  /// uniformly refined or of second order, measured. `size` is the problem's, once scaled. Throws
  /// where a filter fails.
  Steps run(const cadtest::FilterRun& filters, vtkPointSet* mesh, double size) const;

private:
  void markByErrorAndSize(vtkRefineWithCAD* filter, double size) const;
};

} // namespace propertytest
