#include "RandomProblem.h"

#include "DataSets.h"
#include "MeshChecks.h"
#include "MixedMeshes.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <cadrefine/mesh/Facets.h>

#include <vtkCoarsenWithCAD.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>

namespace propertytest
{

namespace
{

using namespace cadrefine;

/// Moves all vertices by up to `length` in each direction.
void shake(Random& random, Mesh& mesh, double length, int dimension)
{
  for (Point3& point : mesh.points)
  {
    for (int k = 0; k < dimension; ++k)
    {
      point[k] += length * random.between(-1, 1);
    }
  }
}

/// The sides round the cells, with their vertices only.
Mesh boundaryOf(const Mesh& mesh)
{
  Mesh surface;
  surface.dimension = 2;
  std::vector<Index> numbers(mesh.points.size(), -1);
  for (const Facet& facet : findOuterFacets(mesh))
  {
    std::array<Index, 4> corners = facet.vertices;
    for (int k = 0; k < facet.corners(); ++k)
    {
      Index& number = numbers[corners[k]];
      if (number < 0)
      {
        number = static_cast<Index>(surface.points.size());
        surface.points.push_back(mesh.points[corners[k]]);
        surface.ids.push_back(number);
      }
      corners[k] = number;
    }
    facet.corners() == 3 ? surface.triangles.push_back({ corners[0], corners[1], corners[2] })
                         : surface.quadrilaterals.push_back(corners);
  }
  return surface;
}

} // namespace

FilterProblem::FilterProblem(Random& random)
{
  const int kind = random.among(0, 5);
  if (kind <= 2) // cube, its surface
  {
    const int n = random.among(2, 3);
    mesh = cadtest::cubeMesh(n, 0.08, random.seed());
    shake(random, mesh, 0.02 / n, 3);
    shape = nearUnitCube(random, random.between(0.01, 0.08));
    isSurface = kind == 2;
    mesh = isSurface ? boundaryOf(mesh) : mesh;
  }
  else if (kind == 3)
  {
    isSurface = random.chance(0.3);
    mesh = isSurface ? cadtest::sphereMesh(1, 0.02) : cadtest::ballMesh(1, 0.02);
    shake(random, mesh, 0.03, 3);
    shape = cadtest::sphere(1);
  }
  else if (kind == 4)
  {
    mesh = cadtest::torusMesh(1, 0.4, random.among(8, 11), random.among(5, 7));
    shake(random, mesh, 0.01, 3);
    shape = cadtest::torus(1, 0.4);
  }
  else
  {
    mesh = cadtest::discMesh(0.95, 0.01, random.among(9, 16));
    shake(random, mesh, 0.02, 2);
    shape = nearUnitCircle(random, random.between(0, 0.05));
  }
}

namespace
{

Mesh anyMix(Random& random, const Mesh& boxes)
{
  return random.chance(0.2) ? boxes : cadtest::randomlyMixedMesh(boxes, random.seed());
}

std::vector<double> anyHeights(Random& random)
{
  std::vector<double> heights{ std::pow(10.0, random.between(-2, -1)) };
  while (heights.back() < 0.4)
  {
    heights.push_back(heights.back() * random.between(1.3, 2.5));
  }
  return heights;
}

/// Layers of one kind, or of any, round the unit sphere.
Mesh anyLayers(Random& random)
{
  using cadtest::BoxKind;
  const int n = random.among(1, 2) + 1;
  const auto heights = anyHeights(random);
  const Mesh boxes = cadtest::hexahedralShellMesh(1, random.between(0, 0.02), n, heights);
  const auto kind = static_cast<BoxKind>(random.among(0, 1));
  const std::size_t layers = heights.size() * 6 * n * n;
  const double others = random.chance(0.5) ? 0 : 0.2;
  const Mesh mesh = cadtest::mixedMesh(
    boxes,
    [&](std::size_t c)
    {
      return c >= layers             ? BoxKind::Fan
             : random.chance(others) ? static_cast<BoxKind>(random.among(0, 4))
                                     : kind;
    },
    random.seed());
  // A fan in a thin layer that is curved may be inverted.
  return cadtest::isValid(mesh) ? mesh : boxes;
}

} // namespace

FilterProblem FilterProblem::mixed(Random& random)
{
  FilterProblem problem;
  Mesh& mesh = problem.mesh;
  const int kind = random.among(0, 5);
  if (kind <= 2) // cube, its surface
  {
    const int n = random.among(2, 3);
    mesh = anyMix(random, cadtest::hexahedraMesh(n, 0.06, random.seed()));
    shake(random, mesh, 0.01 / n, 3);
    problem.shape = nearUnitCube(random, random.between(0.01, 0.08));
    problem.isSurface = kind == 2;
    mesh = problem.isSurface ? boundaryOf(mesh) : mesh;
  }
  else if (kind == 3)
  {
    mesh = anyMix(random,
      cadtest::hexahedralBallMesh(1, random.between(0, 0.02), random.among(1, 2), { 0.5, 1 }));
    shake(random, mesh, 0.01, 3);
    problem.shape = cadtest::sphere(1);
  }
  else if (kind == 4)
  {
    mesh = anyLayers(random);
    problem.shape = cadtest::sphere(1);
  }
  else
  {
    mesh = cadtest::quadrilateralRingMesh(
      1, random.between(0, 0.01), random.among(9, 16), anyHeights(random));
    problem.shape = nearUnitCircle(random, random.between(0, 0.05));
  }
  problem.isBoundaryListed = !problem.isSurface && random.chance(0.7);
  if (problem.isBoundaryListed)
  {
    mesh = cadtest::withListedBoundary(mesh);
  }
  if (random.chance(0.3))
  {
    for (auto& w : mesh.wedges)
    {
      w = { w[3], w[4], w[5], w[0], w[1], w[2] };
    }
  }
  return problem;
}

vtkSmartPointer<vtkPointSet> FilterProblem::dataSet() const
{
  vtkSmartPointer<vtkPointSet> result;
  if (isSurface)
  {
    result = cadtest::toPolyData(mesh);
  }
  else
  {
    result = cadtest::toGrid(mesh);
  }
  cadtest::addArrays(result);
  return result;
}

Plan::Plan(Random& random, const FilterProblem& problem)
{
  dimension = problem.mesh.dimension == 3 || problem.isSurface ? 3 : 2;
  depth = random.among(1, 2);
  isBulk = random.chance(0.4);
  fraction = random.between(0.2, 0.9);
  threshold = std::pow(10.0, random.between(-5, -2));
  levels = random.among(1, 3);
  cutFacets = random.chance(0.4);
  balance = random.chance(0.5);
  chordTolerance = random.chance(0.3) ? random.between(0.005, 0.05) : 0;
  normalAngle = random.chance(0.3) ? random.between(10, 40) : 0;
  straight = random.chance(0.1);
  uniformAfterwards = random.chance(0.3);
  isQuadratic = !problem.isSurface && random.chance(0.2);
  minimumQuality = random.chance(0.5) ? 0.1 : random.between(0.2, 0.5);
  coarseningLevels = straight || random.chance(0.5) ? 0 : random.among(1, 2);
  coarseningError = random.chance(0.3) ? 0 : random.between(0.3, 1.2);
  if (problem.mesh.hasNonSimplices())
  {
    keepLayers = random.chance(0.6);
    levels = random.among(1, 2);
    coarseningLevels = 0; // of simplices alone
  }
}

void Plan::markByErrorAndSize(vtkRefineWithCAD* filter, double size) const
{
  filter->SetMarkingArray("GeometricError");
  filter->SetMarking(isBulk ? vtkRefineWithCAD::BULK : vtkRefineWithCAD::THRESHOLD);
  filter->SetFraction(fraction);
  filter->SetThreshold(threshold * std::pow(size, dimension));
  filter->SetLevels(levels);
  filter->SetCutFacets(cutFacets);
  filter->SetChordTolerance(chordTolerance * size);
  filter->SetNormalAngle(normalAngle);
  filter->SetProjectNewVertices(!straight);
  filter->SetBalance(balance);
  filter->SetMinimumQuality(minimumQuality);
  filter->SetOperations(operations);
  filter->SetKeepLayers(keepLayers);
}

Plan::Steps Plan::run(const cadtest::FilterRun& filters, vtkPointSet* mesh, double size) const
{
  Steps steps{ filters.run<vtkProjectOntoCAD>(
    mesh, [&](vtkProjectOntoCAD* filter) { filter->SetOperations(operations); }) };
  steps.push_back(filters.measure(steps.back(), depth));
  steps.push_back(filters.run<vtkRefineWithCAD>(
    steps.back(), [&](vtkRefineWithCAD* filter) { markByErrorAndSize(filter, size); }));
  if (coarseningLevels > 0 && operations == vtkRefineWithCAD::ALL_OPERATIONS)
  {
    const double error = cadtest::fieldValue(steps[1], "GlobalGeometricError");
    steps.push_back(filters.run<vtkCoarsenWithCAD>(steps.back(),
      [&](vtkCoarsenWithCAD* filter)
      {
        filter->SetLevels(coarseningLevels);
        filter->SetTargetError(coarseningError * error);
        filter->SetMinimumQuality(minimumQuality);
      }));
  }
  if (uniformAfterwards || isQuadratic)
  {
    steps.push_back(filters.run<vtkRefineWithCAD>(steps.back(),
      [&](vtkRefineWithCAD* filter)
      {
        filter->SetMethod(vtkRefineWithCAD::UNIFORM_BISECTION);
        filter->SetLevels(uniformAfterwards ? 1 : 0);
        filter->SetQuadraticCells(isQuadratic);
        filter->SetBalance(balance);
        filter->SetMinimumQuality(minimumQuality);
        filter->SetOperations(operations);
      }));
  }
  steps.push_back(filters.measure(steps.back(), depth));
  return steps;
}

} // namespace propertytest
