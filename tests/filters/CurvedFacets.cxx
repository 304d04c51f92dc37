#include "CurvedFacets.h"

#include <vtkCell.h>
#include <vtkCellType.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>

#include <algorithm>
#include <limits>
#include <map>

namespace cadtest
{

using namespace cadrefine;

namespace
{

constexpr int lattice = 8;

template<std::size_t Count>
std::array<Point3, Count> nodesOf(vtkCell* cell)
{
  std::array<Point3, Count> nodes;
  for (std::size_t n = 0; n < Count; ++n)
  {
    cell->GetPoints()->GetPoint(static_cast<vtkIdType>(n), nodes[n].data());
  }
  return nodes;
}

/// Calls use(l0, l1, l2) at the points of a lattice on the triangle.
template<class Use>
void forEachPlace(int n, const Use& use)
{
  for (int i = 0; i <= n; ++i)
  {
    for (int j = 0; i + j <= n; ++j)
    {
      use(
        static_cast<double>(n - i - j) / n, static_cast<double>(i) / n, static_cast<double>(j) / n);
    }
  }
}

Point3 pointOf(const CurvedFacet& p, double a, double b, double c)
{
  return a * (2 * a - 1) * p[0] + b * (2 * b - 1) * p[1] + c * (2 * c - 1) * p[2] +
         4 * a * b * p[3] + 4 * b * c * p[4] + 4 * c * a * p[5];
}

/// The product of the derivatives along b and c.
Vector3 areaVector(const CurvedFacet& p, double a, double b, double c)
{
  const Vector3 alongA = (4 * a - 1) * p[0] + 4 * b * p[3] + 4 * c * p[5];
  const Vector3 alongB = (4 * b - 1) * p[1] + 4 * a * p[3] + 4 * c * p[4];
  const Vector3 alongC = (4 * c - 1) * p[2] + 4 * b * p[4] + 4 * a * p[5];
  return cross(alongB - alongA, alongC - alongA);
}

/// Nodes in VTK's order, at coordinates l.
double jacobianAt(const std::array<Point3, 10>& p, const std::array<double, 4>& l)
{
  constexpr int edges[6][2] = { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 3 }, { 2, 3 } };
  std::array<Vector3, 4> along;
  for (int k = 0; k < 4; ++k)
  {
    along[k] = (4 * l[k] - 1) * p[k];
  }
  for (int e = 0; e < 6; ++e)
  {
    const auto [a, b] = edges[e];
    along[a] = along[a] + 4 * l[b] * p[4 + e];
    along[b] = along[b] + 4 * l[a] * p[4 + e];
  }
  return dot(along[1] - along[0], cross(along[2] - along[0], along[3] - along[0]));
}

double smallestOf(const std::array<Point3, 10>& p)
{
  const double straight = dot(p[1] - p[0], cross(p[2] - p[0], p[3] - p[0]));
  double smallest = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= lattice; ++k)
  {
    const double top = static_cast<double>(k) / lattice;
    forEachPlace(lattice,
      [&](double a, double b, double c)
      {
        const double rest = 1 - top;
        smallest =
          std::min(smallest, jacobianAt(p, { rest * a, rest * b, rest * c, top }) / straight);
      });
  }
  return smallest;
}

double smallestOf(const CurvedFacet& p)
{
  const double straight = cross(p[1] - p[0], p[2] - p[0])[2];
  double smallest = std::numeric_limits<double>::infinity();
  forEachPlace(lattice, [&](double a, double b, double c)
    { smallest = std::min(smallest, areaVector(p, a, b, c)[2] / straight); });
  return smallest;
}

} // namespace

std::vector<CurvedFacet> outerFacets(vtkPointSet* data)
{
  std::map<std::array<vtkIdType, 3>, std::vector<CurvedFacet>> facets;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    vtkCell* cell = data->GetCell(c);
    for (int f = 0; cell->GetCellType() == VTK_QUADRATIC_TETRA && f < 4; ++f)
    {
      vtkCell* face = cell->GetFace(f);
      std::array<vtkIdType, 3> key{ face->GetPointId(0), face->GetPointId(1), face->GetPointId(2) };
      std::sort(key.begin(), key.end());
      facets[key].push_back(nodesOf<6>(face));
    }
  }
  std::vector<CurvedFacet> outer;
  for (const auto& [key, met] : facets)
  {
    if (met.size() == 1)
    {
      outer.push_back(met[0]);
    }
  }
  return outer;
}

double largestOn(const std::vector<CurvedFacet>& facets, const ValueAt& valueAt)
{
  double largest = 0;
  for (const CurvedFacet& facet : facets)
  {
    forEachPlace(lattice, [&](double a, double b, double c)
      { largest = std::max(largest, valueAt(pointOf(facet, a, b, c))); });
  }
  return largest;
}

double integralOver(const std::vector<CurvedFacet>& facets, const ValueAt& valueAt)
{
  constexpr int n = 32;
  double sum = 0;
  for (const CurvedFacet& facet : facets)
  {
    // The centres of the n * n small triangles are at thirds of the lattice.
    const auto add = [&](double i, double j)
    {
      const double b = i / n;
      const double c = j / n;
      sum += valueAt(pointOf(facet, 1 - b - c, b, c)) * norm(areaVector(facet, 1 - b - c, b, c)) /
             (2.0 * n * n);
    };
    for (int i = 0; i < n; ++i)
    {
      for (int j = 0; i + j < n; ++j)
      {
        add(i + 1.0 / 3, j + 1.0 / 3);
        if (i + j + 1 < n)
        {
          add(i + 2.0 / 3, j + 2.0 / 3);
        }
      }
    }
  }
  return sum;
}

/// By the divergence theorem: x . n is of degree 4 in the parameters. The rule of six points by
/// D. A. Dunavant, Int. J. Numer. Meth. Eng. 21, 1985, is exact for that.
double volumeInside(const std::vector<CurvedFacet>& facets)
{
  constexpr double weights[2] = { 0.223381589678011, 0.109951743655322 };
  constexpr double places[2] = { 0.108103018168070, 0.816847572980459 };
  double volume = 0;
  for (const CurvedFacet& facet : facets)
  {
    for (int q = 0; q < 6; ++q)
    {
      std::array<double, 3> l;
      l.fill((1 - places[q / 3]) / 2);
      l[q % 3] = places[q / 3];
      volume += weights[q / 3] / 6 *
                dot(pointOf(facet, l[0], l[1], l[2]), areaVector(facet, l[0], l[1], l[2]));
    }
  }
  return volume;
}

/// The determinant is of degree 2: the mean of its values in the middles of edges is exact.
double areaOf(vtkPointSet* data)
{
  double area = 0;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    if (data->GetCellType(c) == VTK_QUADRATIC_TRIANGLE)
    {
      const auto nodes = nodesOf<6>(data->GetCell(c));
      area += (areaVector(nodes, 0.5, 0.5, 0)[2] + areaVector(nodes, 0, 0.5, 0.5)[2] +
                areaVector(nodes, 0.5, 0, 0.5)[2]) /
              6;
    }
  }
  return area;
}

double smallestJacobian(vtkPointSet* data)
{
  double smallest = std::numeric_limits<double>::infinity();
  bool solid = false;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    solid = solid || data->GetCellType(c) == VTK_QUADRATIC_TETRA;
  }
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    vtkCell* cell = data->GetCell(c);
    if (solid && cell->GetCellType() == VTK_QUADRATIC_TETRA)
    {
      smallest = std::min(smallest, smallestOf(nodesOf<10>(cell)));
    }
    if (!solid && cell->GetCellType() == VTK_QUADRATIC_TRIANGLE)
    {
      smallest = std::min(smallest, smallestOf(nodesOf<6>(cell)));
    }
  }
  return smallest;
}

} // namespace cadtest
