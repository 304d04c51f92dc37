// What two simplices have in common: closed forms, partitions, another method, and what is flat.

#include "TestMeshes.h"

#include <cadrefine/mesh/Overlap.h>
#include <cadrefine/mesh/Quality.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace
{

using namespace cadrefine;

using Tetrahedron = SimplexPoints<4>;
using Triangle = SimplexPoints<3>;

const Tetrahedron unitCorner{ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
const Triangle unitTriangle{ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } } };

template<std::size_t Corners>
SimplexPoints<Corners> moved(SimplexPoints<Corners> cell, double factor, const Vector3& way)
{
  for (Point3& corner : cell)
  {
    corner = factor * corner + way;
  }
  return cell;
}

template<std::size_t Corners>
double overlap(const SimplexPoints<Corners>& a, const SimplexPoints<Corners>& b)
{
  return cadrefine::overlap(SimplexFrame<Corners>(a), SimplexFrame<Corners>(b));
}

class Random
{
public:
  explicit Random(unsigned seed) : engine_(seed) {}

  double number() { return static_cast<double>(engine_()) / 4294967296.0; }
  Point3 point() { return { number(), number(), number() }; }
  template<std::size_t Corners>
  SimplexPoints<Corners> cell()
  {
    SimplexPoints<Corners> result;
    std::generate(result.begin(), result.end(), [&] { return point(); });
    return result;
  }

private:
  std::mt19937 engine_;
};

/// By another way: the facets of the intersection are found from its vertices, which are the
/// corners of each in the other and the crossings of edges with faces; the volume is that of the
/// convex hull of these, by the planes that have all of them on one side.
double hullOfIntersection(const Tetrahedron& a, const Tetrahedron& b)
{
  struct Plane
  {
    Vector3 normal;
    double offset;
  };
  std::vector<Plane> planes;
  for (const Tetrahedron& cell : { a, b })
  {
    for (int k = 0; k < 4; ++k)
    {
      const Point3& p = cell[(k + 1) % 4];
      Vector3 normal = normalized(cross(cell[(k + 2) % 4] - p, cell[(k + 3) % 4] - p));
      if (dot(normal, cell[k] - p) > 0)
      {
        normal = -1.0 * normal;
      }
      planes.push_back({ normal, dot(normal, p) });
    }
  }
  std::vector<std::vector<Point3>> onPlane(planes.size());
  for (std::size_t i = 0; i < planes.size(); ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      for (std::size_t k = 0; k < j; ++k)
      {
        const Vector3 normals = cross(planes[j].normal, planes[k].normal);
        const double det = dot(planes[i].normal, normals);
        if (std::abs(det) < 1e-9)
        {
          continue;
        }
        const Point3 vertex =
          (1 / det) * (planes[i].offset * normals +
                        planes[j].offset * cross(planes[k].normal, planes[i].normal) +
                        planes[k].offset * cross(planes[i].normal, planes[j].normal));
        const bool isInside = std::all_of(planes.begin(), planes.end(),
          [&](const Plane& plane) { return dot(plane.normal, vertex) <= plane.offset + 1e-11; });
        for (const std::size_t plane : { i, j, k })
        {
          if (isInside)
          {
            onPlane[plane].push_back(vertex);
          }
        }
      }
    }
  }
  // The cone from one vertex over each facet, as a polygon that is sorted by angle.
  double volume = 0;
  const auto first = std::find_if(
    onPlane.begin(), onPlane.end(), [](const auto& vertices) { return !vertices.empty(); });
  for (std::size_t i = 0; first != onPlane.end() && i < planes.size(); ++i)
  {
    auto& vertices = onPlane[i];
    if (vertices.size() < 3)
    {
      continue;
    }
    const Point3 middle = (1.0 / static_cast<double>(vertices.size())) *
                          std::accumulate(vertices.begin(), vertices.end(), Point3{},
                            [](const Point3& sum, const Point3& vertex) { return sum + vertex; });
    const Vector3 along = normalized(vertices[0] - middle);
    const Vector3 across = cross(planes[i].normal, along);
    const auto angle = [&](const Point3& p)
    { return std::atan2(dot(p - middle, across), dot(p - middle, along)); };
    std::sort(vertices.begin(), vertices.end(),
      [&](const Point3& p, const Point3& q) { return angle(p) < angle(q); });
    for (std::size_t v = 0; v < vertices.size(); ++v)
    {
      volume += std::abs(sixfoldVolume(
                  first->front(), middle, vertices[v], vertices[(v + 1) % vertices.size()])) /
                6;
    }
  }
  return volume;
}

TEST(Overlap, ofACellWithItselfIsItsVolume)
{
  EXPECT_DOUBLE_EQ(overlap(unitCorner, unitCorner), 1.0 / 6);
  EXPECT_DOUBLE_EQ(overlap(unitTriangle, unitTriangle), 0.5);
  Tetrahedron turned = unitCorner;
  std::swap(turned[0], turned[2]);
  EXPECT_DOUBLE_EQ(overlap(turned, unitCorner), 1.0 / 6);
}

TEST(Overlap, ofShiftedCopiesIsASmallerCopy)
{
  const double root = std::sqrt(0.5);
  const Tetrahedron regular{ { { 1, 0, -root }, { -1, 0, -root }, { 0, 1, root },
    { 0, -1, root } } };
  for (const double part : { 0.0, 0.125, 0.5, 0.9, 0.999 })
  {
    // along an edge, what is left is the cell scaled by the rest of the way, at the other end
    const Vector3 way = part * (regular[1] - regular[0]);
    const double rest = 1 - part;
    EXPECT_NEAR(
      overlap(regular, moved(regular, 1, way)), rest * rest * rest * measure(regular), 2e-15);
    const Vector3 inPlane = part * (unitTriangle[2] - unitTriangle[0]);
    EXPECT_NEAR(overlap(unitTriangle, moved(unitTriangle, 1, inPlane)), rest * rest / 2, 2e-15);
  }
}

TEST(Overlap, ofNestedCellsIsTheSmallerOne)
{
  for (const double factor : { 1e-6, 0.01, 0.2 })
  {
    const Tetrahedron small = moved(unitCorner, factor, { 0.1, 0.2, 0.1 });
    EXPECT_NEAR(overlap(small, unitCorner), measure(small), 1e-14 * measure(small));
    EXPECT_NEAR(overlap(unitCorner, small), measure(small), 1e-14 * measure(small));
    const Triangle flat = moved(unitTriangle, factor, { 0.1, 0.2, 0 });
    EXPECT_NEAR(overlap(flat, unitTriangle), measure(flat), 1e-14 * measure(flat));
    EXPECT_NEAR(overlap(unitTriangle, flat), measure(flat), 1e-14 * measure(flat));
  }
}

TEST(Overlap, ofOppositeCornersOfACube)
{
  // of the unit cube what lies between x + y + z = 1 and 2: all but two corners
  const Tetrahedron one = moved(unitCorner, 2, {});
  const Tetrahedron other = moved(unitCorner, -2, { 1, 1, 1 });
  EXPECT_NEAR(overlap(one, other), 1 - 2.0 / 6, 1e-15);
}

TEST(Overlap, ofCellsThatTouchOrAreApartIsNothing)
{
  Random random(3);
  for (int trial = 0; trial < 1000; ++trial)
  {
    const auto cell = random.cell<4>();
    for (int corner = 0; corner < 4; ++corner)
    {
      Tetrahedron mirrored = cell; // on the other side of a face
      const Point3 onFace =
        (1.0 / 3) * (cell[(corner + 1) % 4] + cell[(corner + 2) % 4] + cell[(corner + 3) % 4]);
      mirrored[corner] = 2.0 * onFace - cell[corner];
      EXPECT_LE(overlap(cell, mirrored), 1e-15);
    }
    EXPECT_EQ(overlap(cell, moved(cell, 1, { 1, 1, 1 })), 0);
  }
  EXPECT_EQ(overlap(unitCorner, moved(unitCorner, -1, {})), 0);
  EXPECT_EQ(overlap(unitTriangle, moved(unitTriangle, 1, { 1, 0, 0 })), 0);
}

TEST(Overlap, ofFlatCellsIsNothing)
{
  Tetrahedron flat = unitCorner;
  flat[3] = { 0.3, 0.3, 0 };
  Tetrahedron point;
  point.fill({ 0.1, 0.1, 0.1 });
  for (const Tetrahedron& cell : { flat, point })
  {
    EXPECT_EQ(overlap(cell, unitCorner), 0);
    EXPECT_EQ(overlap(unitCorner, cell), 0);
    EXPECT_EQ(overlap(cell, cell), 0);
  }
  Triangle line = unitTriangle;
  line[2] = { 0.5, 0, 0 };
  EXPECT_EQ(overlap(line, unitTriangle), 0);
  EXPECT_EQ(overlap(unitTriangle, line), 0);
  // as thin as it can be: between 0 and its volume
  flat[3][2] = 1e-17;
  EXPECT_LE(overlap(flat, unitCorner), measure(flat));
  EXPECT_GE(overlap(flat, unitCorner), 0);
}

TEST(Overlap, ofRandomCellsIsThatOfAnotherMethod)
{
  Random random(11);
  int many = 0;
  for (int trial = 0; trial < 20000; ++trial)
  {
    const auto a = random.cell<4>();
    const auto b = random.cell<4>();
    if (std::min(measure(a), measure(b)) > 1e-3)
    {
      const double volume = overlap(a, b);
      many += volume > 1e-3;
      ASSERT_NEAR(volume, hullOfIntersection(a, b), 1e-10) << "trial " << trial;
      ASSERT_NEAR(volume, overlap(b, a), 1e-14);
    }
  }
  EXPECT_GT(many, 1000);
}

/// The cells of a partition that overlaps are sought with make the cell again.
TEST(Overlap, withAPartitionSumsToTheCell)
{
  const Mesh cube = cadtest::cubeMesh(3, 0.1, 5);
  std::vector<Tetrahedron> cells;
  for (const auto& corners : cube.tetrahedra)
  {
    Tetrahedron cell;
    std::transform(
      corners.begin(), corners.end(), cell.begin(), [&](Index v) { return cube.points[v]; });
    cells.push_back(cell);
  }
  Random random(17);
  for (int trial = 0; trial < 300; ++trial)
  {
    const auto cell = random.cell<4>();
    if (measure(cell) < 0.02)
    {
      continue; // what is thin has larger errors, for its volume
    }
    double sum = 0;
    for (const Tetrahedron& part : cells)
    {
      sum += overlap(part, cell);
    }
    EXPECT_NEAR(sum, measure(cell), 1e-14 * measure(cell));
  }
}

TEST(Overlap, ofTrianglesWithAPartitionSumsToTheTriangle)
{
  const Mesh square = cadtest::squareMesh(4, 0.1, 5);
  Random random(19);
  for (int trial = 0; trial < 300; ++trial)
  {
    auto cell = random.cell<3>();
    for (Point3& corner : cell)
    {
      corner[2] = 0;
    }
    if (twofoldAreaVector(cell[0], cell[1], cell[2])[2] < 0)
    {
      std::swap(cell[0], cell[1]);
    }
    double sum = 0;
    for (const auto& [i, j, k] : square.triangles)
    {
      sum += overlap(Triangle{ square.points[i], square.points[j], square.points[k] }, cell);
    }
    EXPECT_NEAR(sum, measure(cell), 1e-15);
  }
}

TEST(Overlap, ofTrianglesInSpaceIsThatOfTheProjection)
{
  // a plane at 60 degrees: areas halve on the way
  const double height = std::sqrt(3.0);
  const Triangle steep{ { { 0, 0, 0 }, { 1, 0, height }, { 0, 1, 0 } } };
  EXPECT_NEAR(overlap(steep, unitTriangle), 0.5, 1e-15);
  EXPECT_NEAR(overlap(moved(steep, 1, { 0, 0, 5 }), unitTriangle), 0.5, 1e-15);
  // the other way: the unit triangle falls onto a part of a quarter of the steep one's length
  EXPECT_NEAR(overlap(unitTriangle, steep), 0.25, 1e-15);
  // from the other side
  const Triangle below{ { { 0, 0, -0.1 }, { 0, 1, -0.1 }, { 1, 0, -0.1 } } };
  EXPECT_EQ(overlap(below, unitTriangle), 0);
}

TEST(SimplexFrame, coordinatesMakeThePoint)
{
  Random random(23);
  for (int trial = 0; trial < 1000; ++trial)
  {
    const auto cell = random.cell<4>();
    const Point3 point = random.point();
    const auto parts = SimplexFrame<4>(cell).coordinates(point);
    Point3 made{};
    for (int k = 0; k < 4; ++k)
    {
      made = made + parts[k] * cell[k];
    }
    EXPECT_LT(distance(made, point), 1e-15 / measure(cell) + 1e-14);
    EXPECT_EQ(SimplexFrame<4>(cell).coordinates(cell[0]), (std::array<double, 4>{ 1, 0, 0, 0 }));
  }
  const auto parts = SimplexFrame<3>(unitTriangle).coordinates({ 0.25, 0.5, 7 });
  EXPECT_NEAR(parts[0], 0.25, 1e-15);
  EXPECT_NEAR(parts[1], 0.25, 1e-15);
  EXPECT_NEAR(parts[2], 0.5, 1e-15);
}

} // namespace
