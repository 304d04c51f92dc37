#include "BlockMeshes.h"

#include <cadrefine/base/Vector3.h>
#include <cadrefine/mesh/Mesh.h>

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace cadtest
{

using namespace cadrefine;

namespace
{

using Corners = std::vector<vtkIdType>;

Grid makeGrid(const std::vector<Point3>& points)
{
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  for (const Point3& point : points)
  {
    places->InsertNextPoint(point.data());
  }
  auto grid = Grid::New();
  grid->SetPoints(places);
  return grid;
}

void add(Grid& grid, int type, const Corners& corners)
{
  grid->InsertNextCell(type, static_cast<vtkIdType>(corners.size()), corners.data());
}

/// Corners of a cube, those of a larger one on the sphere but for an offset, and the centre.
std::vector<Point3> pointsOfBall(double radius)
{
  constexpr Point3 corners[8] = { { -1, -1, -1 }, { 1, -1, -1 }, { 1, 1, -1 }, { -1, 1, -1 },
    { -1, -1, 1 }, { 1, -1, 1 }, { 1, 1, 1 }, { -1, 1, 1 } };
  std::vector<Point3> points;
  for (const double length : { 0.5, 1.0 })
  {
    for (int k = 0; k < 8; ++k)
    {
      const double offset = length == 1 ? 0.02 * std::sin(3.0 * k) : 0;
      points.push_back(length * radius * (1 + offset) / std::sqrt(3.0) * corners[k]);
    }
  }
  points.push_back({ 0, 0, 0 });
  return points;
}

/// On the sides of the cube whose corners begin there.
void addPyramids(Grid& grid, vtkIdType first)
{
  for (const auto& [a, b, c, d] : shapes::Hexahedron::faces)
  {
    add(grid, VTK_PYRAMID, { first + d, first + c, first + b, first + a, 16 });
  }
}

void addShell(Grid& grid)
{
  for (const auto& [a, b, c, d] : shapes::Hexahedron::faces)
  {
    add(grid, VTK_HEXAHEDRON, { a, b, c, d, a + 8, b + 8, c + 8, d + 8 });
  }
}

/// The determinant of the Jacobian, by VTK's derivatives.
double jacobianAt(vtkCell* cell, const std::array<double, 3>& where)
{
  const int count = cell->GetNumberOfPoints();
  const int dimension = cell->GetCellDimension();
  std::vector<double> derivatives(3 * static_cast<std::size_t>(count));
  cell->InterpolateDerivs(where.data(), derivatives.data());
  std::array<Vector3, 3> along{};
  along[2][2] = dimension == 2 ? 1 : 0;
  for (int d = 0; d < dimension; ++d)
  {
    for (int n = 0; n < count; ++n)
    {
      Point3 point;
      cell->GetPoints()->GetPoint(n, point.data());
      along[d] = along[d] + derivatives[static_cast<std::size_t>(d) * count + n] * point;
    }
  }
  return dot(along[0], cross(along[1], along[2]));
}

/// Barycentric limits of the cell's parameters.
bool isInside(int type, const std::array<double, 3>& where)
{
  switch (type)
  {
    case VTK_QUADRATIC_TETRA:
      return where[0] + where[1] + where[2] <= 1;
    case VTK_QUADRATIC_TRIANGLE:
    case VTK_QUADRATIC_WEDGE:
      return where[0] + where[1] <= 1;
    case VTK_QUADRATIC_PYRAMID:
      return where[2] < 1; // the determinant vanishes at the apex
    default:
      return true;
  }
}

template<class Use>
void forEachLargest(vtkPointSet* data, const Use& use)
{
  int dimension = 0;
  for (const bool found : { false, true })
  {
    for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
    {
      vtkCell* cell = data->GetCell(c);
      if (!found)
      {
        dimension = std::max(dimension, cell->GetCellDimension());
      }
      else if (cell->GetCellDimension() == dimension)
      {
        use(cell, c);
      }
    }
  }
}

struct Weighted
{
  std::array<double, 3> where;
  double weight;
};

/// Exact for polynomials of degree 5 in each parameter, of a wedge's triangle in both of degree 5
/// together (J. Radon 1948), of a tetrahedron of degree 3.
std::vector<Weighted> ruleOf(int type)
{
  if (type == VTK_QUADRATIC_TETRA || type == VTK_TETRA)
  {
    std::vector<Weighted> rule{ { { 0.25, 0.25, 0.25 }, -2.0 / 15 } };
    for (int k = 0; k < 4; ++k)
    {
      rule.push_back(
        { { k == 0 ? 0.5 : 1.0 / 6, k == 1 ? 0.5 : 1.0 / 6, k == 2 ? 0.5 : 1.0 / 6 }, 3.0 / 40 });
    }
    return rule;
  }
  const double g = std::sqrt(0.6) / 2;
  const std::array<std::array<double, 2>, 3> gauss{ { { 0.5 - g, 5.0 / 18 }, { 0.5, 8.0 / 18 },
    { 0.5 + g, 5.0 / 18 } } };
  std::vector<Weighted> plane;
  if (type == VTK_QUADRATIC_WEDGE || type == VTK_WEDGE)
  {
    plane.push_back({ { 1.0 / 3, 1.0 / 3, 0 }, 9.0 / 80 });
    for (const double sign : { -1.0, 1.0 })
    {
      const double a = (6 + sign * std::sqrt(15.0)) / 21;
      const double weight = (155 + sign * std::sqrt(15.0)) / 2400;
      for (const auto& [u, v] : { std::array{ a, a }, { 1 - 2 * a, a }, { a, 1 - 2 * a } })
      {
        plane.push_back({ { u, v, 0 }, weight });
      }
    }
  }
  else
  {
    for (const auto& [u, ofU] : gauss)
    {
      for (const auto& [v, ofV] : gauss)
      {
        plane.push_back({ { u, v, 0 }, ofU * ofV });
      }
    }
  }
  if (type == VTK_QUADRATIC_QUAD || type == VTK_QUAD)
  {
    return plane;
  }
  std::vector<Weighted> rule;
  for (const auto& [where, weight] : plane)
  {
    for (const auto& [t, ofT] : gauss)
    {
      rule.push_back({ { where[0], where[1], t }, weight * ofT });
    }
  }
  return rule;
}

} // namespace

Grid ballWithPyramids(double radius)
{
  Grid grid = makeGrid(pointsOfBall(radius));
  addPyramids(grid, 0);
  addShell(grid);
  return grid;
}

Grid cubeOfPyramids(double radius)
{
  Grid grid = makeGrid(pointsOfBall(radius));
  addPyramids(grid, 8);
  return grid;
}

Grid cylinderOfWedges(double radius, double height, int corners, int layers, bool documented)
{
  std::vector<Point3> points;
  for (int layer = 0; layer <= layers; ++layer)
  {
    const double z = height * layer / layers;
    points.push_back({ 0, 0, z });
    for (int k = 0; k < corners; ++k)
    {
      const double angle = 2 * std::acos(-1.0) * k / corners;
      points.push_back({ radius * std::cos(angle), radius * std::sin(angle), z });
    }
  }
  Grid grid = makeGrid(points);
  for (int layer = 0; layer < layers; ++layer)
  {
    const vtkIdType low = layer * (corners + 1);
    const vtkIdType high = low + corners + 1;
    for (int k = 0; k < corners; ++k)
    {
      const vtkIdType a = 1 + k;
      const vtkIdType b = 1 + (k + 1) % corners;
      add(grid, VTK_WEDGE,
        documented ? Corners{ high, high + a, high + b, low, low + a, low + b }
                   : Corners{ low, low + a, low + b, high, high + a, high + b });
    }
  }
  return grid;
}

Grid discOfQuadrilaterals(double radius)
{
  // Round the middle: eight points of a square, and eight on the circle.
  std::vector<Point3> points{ { 0, 0, 0 } };
  for (const bool onCircle : { false, true })
  {
    for (int k = 0; k < 8; ++k)
    {
      const double angle = std::acos(-1.0) * (k - 3) / 4; // from a corner of the square
      const double length = onCircle ? 1 : k % 2 == 0 ? 0.5 : 0.4;
      points.push_back({ length * radius * std::cos(angle), length * radius * std::sin(angle), 0 });
    }
  }
  Grid grid = makeGrid(points);
  for (vtkIdType k = 0; k < 8; ++k)
  {
    const vtkIdType next = (k + 1) % 8;
    add(grid, VTK_QUAD, { 1 + next, 1 + k, 9 + k, 9 + next });
    if (k % 2 == 0)
    {
      add(grid, VTK_QUAD, { 0, 1 + (k + 7) % 8, 1 + k, 1 + next });
    }
  }
  return grid;
}

Grid sphereOfQuadrilaterals(double radius)
{
  const auto points = pointsOfBall(radius);
  Grid grid = makeGrid({ points.begin() + 8, points.begin() + 16 });
  for (const auto& [a, b, c, d] : shapes::Hexahedron::faces)
  {
    add(grid, VTK_QUAD, { a, b, c, d });
  }
  return grid;
}

double smallestSample(vtkPointSet* data, bool documented)
{
  double smallest = std::numeric_limits<double>::infinity();
  forEachLargest(data,
    [&](vtkCell* cell, vtkIdType)
    {
      constexpr int n = 5;
      const int layers = cell->GetCellDimension() == 3 ? n : 0;
      for (int i = 0; i <= n; ++i)
      {
        for (int j = 0; j <= n; ++j)
        {
          for (int k = 0; k <= layers; ++k)
          {
            const std::array<double, 3> where{ i / double(n), j / double(n), k / double(n) };
            if (isInside(cell->GetCellType(), where))
            {
              smallest = std::min(smallest, (documented ? -1 : 1) * jacobianAt(cell, where));
            }
          }
        }
      }
    });
  return smallest;
}

double sizeOf(vtkPointSet* data, const char* density)
{
  double ofWedges = 0; // which may turn either way, all alike
  double ofOthers = 0;
  vtkDataArray* values = density ? data->GetCellData()->GetArray(density) : nullptr;
  forEachLargest(data,
    [&](vtkCell* cell, vtkIdType number)
    {
      const double value = values ? values->GetTuple1(number) : 1;
      const int type = cell->GetCellType();
      double& size = type == VTK_WEDGE || type == VTK_QUADRATIC_WEDGE ? ofWedges : ofOthers;
      for (const auto& [where, weight] : ruleOf(type))
      {
        size += value * weight * jacobianAt(cell, where);
      }
    });
  return std::abs(ofWedges) + std::abs(ofOthers);
}

} // namespace cadtest
