// Meshes of second order: their mid nodes lie on the CAD, their cells are valid, and their distance
// from the CAD falls at third order.

#include "DataSets.h"
#include "FilterRun.h"
#include "Quality.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <gtest/gtest.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <map>

namespace
{

using namespace cadrefine;

constexpr double pi = 3.14159265358979323846;

/// Quadratic triangles by which the cells of dimension 3 meet the outside.
std::vector<std::array<Point3, 6>> outerFacets(vtkPointSet* data)
{
  std::map<std::array<vtkIdType, 3>, std::vector<std::array<Point3, 6>>> facets;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    vtkCell* cell = data->GetCell(c);
    for (int f = 0; cell->GetCellDimension() == 3 && f < cell->GetNumberOfFaces(); ++f)
    {
      vtkCell* face = cell->GetFace(f);
      std::array<vtkIdType, 3> key{ face->GetPointId(0), face->GetPointId(1), face->GetPointId(2) };
      std::sort(key.begin(), key.end());
      std::array<Point3, 6> nodes;
      for (int n = 0; n < 6; ++n)
      {
        face->GetPoints()->GetPoint(n, nodes[n].data());
      }
      facets[key].push_back(nodes);
    }
  }
  std::vector<std::array<Point3, 6>> outer;
  for (const auto& [key, met] : facets)
  {
    if (met.size() == 1)
    {
      outer.push_back(met[0]);
    }
  }
  return outer;
}

/// The largest value at points all over the facets.
template<class Distance>
double largestOn(const std::vector<std::array<Point3, 6>>& facets, const Distance& distanceOf)
{
  constexpr int n = 8;
  double largest = 0;
  for (const auto& p : facets)
  {
    for (int i = 0; i <= n; ++i)
    {
      for (int j = 0; i + j <= n; ++j)
      {
        const double a = static_cast<double>(i) / n;
        const double b = static_cast<double>(j) / n;
        const double c = 1 - a - b;
        const Point3 point = a * (2 * a - 1) * p[0] + b * (2 * b - 1) * p[1] +
                             c * (2 * c - 1) * p[2] + 4 * a * b * p[3] + 4 * b * c * p[4] +
                             4 * c * a * p[5];
        largest = std::max(largest, distanceOf(point));
      }
    }
  }
  return largest;
}

/// Volume inside the facets, by the divergence theorem and a quadrature rule of degree 4, which is
/// exact: the position is of degree 2 and the area vector too.
double volumeInside(const std::vector<std::array<Point3, 6>>& facets)
{
  // D. A. Dunavant, Int. J. Numer. Meth. Eng. 21, 1985: six points.
  constexpr double weights[2] = { 0.223381589678011, 0.109951743655322 };
  constexpr double places[2] = { 0.108103018168070, 0.816847572980459 };
  double volume = 0;
  for (const auto& p : facets)
  {
    for (int q = 0; q < 6; ++q)
    {
      std::array<double, 3> l;
      l.fill((1 - places[q / 3]) / 2);
      l[q % 3] = places[q / 3];
      Point3 point{};
      Vector3 along[3]{};
      for (int k = 0; k < 3; ++k)
      {
        const int next = (k + 1) % 3;
        point = point + l[k] * (2 * l[k] - 1) * p[k] + 4 * l[k] * l[next] * p[3 + k];
        along[k] = along[k] + (4 * l[k] - 1) * p[k] + 4 * l[next] * p[3 + k];
        along[next] = along[next] + 4 * l[k] * p[3 + k];
      }
      volume +=
        weights[q / 3] / 2 / 3 * dot(point, cross(along[1] - along[0], along[2] - along[0]));
    }
  }
  return volume;
}

/// A solid with its coarse mesh and its closed forms.
struct Solid
{
  std::string name;
  TopoDS_Shape shape;
  vtkSmartPointer<vtkPointSet> mesh;
  double volume;
  double (*distance)(const Point3&);
};

double distanceToSphere(const Point3& p)
{
  return std::abs(norm(p) - 2);
}

double distanceToTorus(const Point3& p)
{
  return std::abs(std::hypot(std::hypot(p[0], p[1]) - 3, p[2]) - 1);
}

Solid ball()
{
  return { "Ball", cadtest::sphere(2), cadtest::toGrid(cadtest::ballMesh(2, 0.03)), 32 * pi / 3,
    distanceToSphere };
}

/// With a tetrahedron that has two facets on the sphere.
Solid coarseBall()
{
  return { "CoarseBall", cadtest::sphere(2), cadtest::readGrid(CADREFINE_DATA "/ball_coarse.vtu"),
    32 * pi / 3, distanceToSphere };
}

Solid solidTorus()
{
  return { "Torus", cadtest::torus(3, 1), cadtest::toGrid(cadtest::torusMesh(3, 1, 12, 6)),
    6 * pi * pi, distanceToTorus };
}

class Quadratic : public testing::TestWithParam<Solid (*)()>
{
};

INSTANTIATE_TEST_SUITE_P(Solids, Quadratic, testing::Values(ball, coarseBall, solidTorus),
  [](const auto& solid) { return solid.param().name; });

TEST_P(Quadratic, explore)
{
  const Solid solid = GetParam()();
  cadtest::TemporaryFolder folder;
  const cadtest::FilterRun filters(cadtest::writeInto(folder, solid.shape, ".step"));
  auto data = filters.project(solid.mesh);
  for (int level = 1; level <= 4; ++level)
  {
    const auto quadratic = filters.run<vtkRefineWithCAD>(data,
      [](vtkRefineWithCAD* f)
      {
        f->SetMethod(vtkRefineWithCAD::UNIFORM_BISECTION);
        f->QuadraticCellsOn();
      });
    data = filters.refineUniformly(data);
    const auto facets = outerFacets(quadratic);
    const auto nodes = quadratic->GetPointData()->GetArray("CADDistance");
    double farthest = 0;
    for (vtkIdType p = 0; p < nodes->GetNumberOfTuples(); ++p)
      farthest = std::max(farthest, nodes->GetTuple1(p));
    std::cout << solid.name << " " << level << " cells " << quadratic->GetNumberOfCells() << " off "
              << cadtest::fieldValue(quadratic, "UnprojectedVertices") << " by " << farthest
              << " invalid " << cadtest::fieldValue(quadratic, "InvalidCells") << " of CAD "
              << cadtest::fieldValue(quadratic, "CADVertices") << " distance "
              << largestOn(facets, solid.distance) << " volume " << volumeInside(facets) - solid.volume << "\n";
  }
}

} // namespace
