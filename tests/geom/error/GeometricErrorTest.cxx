// Error of polygons and polyhedra inscribed in shapes of known area and volume.

#include "FacetAlone.h"
#include "MeshChecks.h"
#include "TestMeshes.h"
#include "TestShapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace
{

using namespace cadrefine;

constexpr double pi = 3.14159265358979323846;

ErrorFacet facetOf(const BoundaryProjector& projector, const std::array<Point3, 3>& points)
{
  ErrorFacet facet;
  facet.corners.points = { points[0], points[1], points[2] };
  for (int k = 0; k < 3; ++k)
  {
    facet.corners.entities[k] =
      projector.nearest(points[k], std::numeric_limits<double>::infinity()).entity;
    facet.edges[k] = { EdgeClass::Smooth, -1 };
  }
  return facet;
}

FacetError errorOf(const BoundaryProjector& projector, const Mesh& surface, int depth)
{
  FacetError sum;
  for (const auto& cell : surface.triangles)
  {
    const FacetError part = cadtest::geometricError(projector,
      facetOf(
        projector, { surface.points[cell[0]], surface.points[cell[1]], surface.points[cell[2]] }),
      depth);
    sum.measure += part.measure;
    sum.lastLevel += part.lastLevel;
    sum.largestDistance = std::max(sum.largestDistance, part.largestDistance);
  }
  return sum;
}

/// Chord of a circle that spans this angle.
class Chord : public testing::TestWithParam<double>
{
protected:
  static constexpr double radius = 3;
  std::shared_ptr<const CADModel> model = cadtest::modelOf(cadtest::circle(radius), ".brep");
  BoundaryProjector projector{ *model, BoundaryKind::Edges };

  ErrorFacet facet() const
  {
    const double angle = GetParam();
    return facetOf(
      projector, { { { radius * std::cos(1.0), radius * std::sin(1.0), 0 },
                   { radius * std::cos(1 + angle), radius * std::sin(1 + angle), 0 }, {} } });
  }
};

INSTANTIATE_TEST_SUITE_P(Angles, Chord, testing::Values(1.5, 0.5, 0.1));

TEST_P(Chord, errorAtDepthFourIsTheSegmentsAreaToOnePercent)
{
  const double angle = GetParam();
  const double area = radius * radius * (angle - std::sin(angle)) / 2;
  EXPECT_NEAR(cadtest::geometricError(projector, facet(), 4).measure, area, 0.01 * area);
}

TEST_P(Chord, theLastLevelIsWhatItsDepthAdds)
{
  const double angle = GetParam();
  const double area = radius * radius * (angle - std::sin(angle)) / 2;
  double before = 0;
  for (int depth = 1; depth <= 5; ++depth)
  {
    const FacetError error = cadtest::geometricError(projector, facet(), depth);
    EXPECT_NEAR(error.lastLevel, error.measure - before, 1e-14 * area);
    EXPECT_NEAR(extrapolatedMeasure(error), area, 0.06 * std::pow(0.1, depth - 1) * area) << depth;
    before = error.measure;
  }
}

TEST_P(Chord, errorConvergesLikeFourToTheDepth)
{
  const double angle = GetParam();
  const double area = radius * radius * (angle - std::sin(angle)) / 2;
  double before = area;
  for (int depth = 1; depth <= 5; ++depth)
  {
    const double missing = area - cadtest::geometricError(projector, facet(), depth).measure;
    EXPECT_GT(before / missing, 3.6);
    EXPECT_LT(before / missing, 4.4);
    before = missing;
  }
}

TEST_P(Chord, distanceIsTheSagitta)
{
  EXPECT_NEAR(cadtest::geometricError(projector, facet(), 3).largestDistance,
    radius * (1 - std::cos(GetParam() / 2)), 1e-9);
}

TEST_P(Chord, firstEstimateIsTheTriangleOverTheChord)
{
  const double angle = GetParam();
  EXPECT_NEAR(cadtest::geometricError(projector, facet(), 1).measure,
    radius * std::sin(angle / 2) * radius * (1 - std::cos(angle / 2)), 1e-9);
}

TEST(SphereError, isTheVolumeDeficitOfAnInscribedIcosahedron)
{
  const auto model = cadtest::modelOf(cadtest::sphere(2));
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  const Mesh surface = cadtest::sphereMesh(2, 0);
  const double deficit = 4.0 / 3.0 * pi * 8 - cadtest::volumeInside(surface);
  double before = deficit;
  for (int depth = 1; depth <= 4; ++depth)
  {
    const FacetError error = errorOf(projector, surface, depth);
    const double missing = deficit - error.measure;
    EXPECT_GT(missing, 0);
    EXPECT_NEAR(error.lastLevel, before - missing, 1e-12);
    EXPECT_NEAR(extrapolatedMeasure(error), deficit, (depth == 1 ? 0.1 : 0.01) * deficit);
    EXPECT_LT(missing, before / (depth == 1 ? 3 : 3.6)) << "depth " << depth;
    before = missing;
  }
  EXPECT_LT(before, 0.01 * deficit);
}

/// The facets of a mesh with the edges that they share.
ClassifiedSurface surfaceOf(const BoundaryProjector& projector, const Mesh& mesh)
{
  ClassifiedSurface surface;
  for (const Point3& point : mesh.points)
  {
    surface.points.push_back(
      { point, projector.nearest(point, std::numeric_limits<double>::infinity()).entity });
  }
  std::map<std::pair<Index, Index>, Index> edges;
  for (const auto& corners : mesh.triangles)
  {
    SurfaceFacet facet{ { corners[0], corners[1], corners[2] }, {} };
    for (int k = 0; k < 3; ++k)
    {
      const auto ends = std::minmax(corners[k], corners[(k + 1) % 3]);
      const auto [edge, isNew] = edges.emplace(ends, static_cast<Index>(edges.size()));
      facet.edges[k] = edge->second;
      if (isNew)
      {
        surface.edges.push_back({ { ends.first, ends.second }, { EdgeClass::Smooth, -1 } });
      }
    }
    surface.facets.push_back(facet);
  }
  return surface;
}

/// To the last bit; each edge of each level is projected once, in one part.
TEST(SphereError, ofFacetsThatShareEdgesIsThatOfEachAlone)
{
  const auto model = cadtest::modelOf(cadtest::sphere(2));
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  const Mesh mesh = cadtest::sphereMesh(2, 0);
  const ClassifiedSurface surface = surfaceOf(projector, mesh);
  for (const std::size_t parts : { 1u, 3u, 200u })
  {
    std::size_t projections = 0;
    const auto project = [&](const std::vector<BoundaryEdge>& edges)
    {
      projections += edges.size();
      return cadtest::projectEdges(projector, edges);
    };
    const auto errors = geometricErrors(surface, project(surface.allEdges()), 3, parts, project);
    ASSERT_EQ(errors.size(), 20u);
    for (std::size_t f = 0; f < errors.size(); ++f)
    {
      const auto& [a, b, c] = mesh.triangles[f];
      const FacetError alone = cadtest::geometricError(
        projector, facetOf(projector, { mesh.points[a], mesh.points[b], mesh.points[c] }), 3);
      EXPECT_EQ(errors[f].measure, alone.measure);
      EXPECT_EQ(errors[f].lastLevel, alone.lastLevel);
      EXPECT_EQ(errors[f].chordError, alone.chordError);
      EXPECT_EQ(errors[f].largestDistance, alone.largestDistance);
    }
    if (parts == 1)
    {
      EXPECT_EQ(projections, 30u + 120u + 480u); // edges of the sphere's three levels
    }
  }
}

/// Side of a prism with 12 corners, two triangles each, inscribed in a cylinder.
Mesh prismSide(double radius, double height)
{
  Mesh mesh;
  mesh.dimension = 2;
  for (Index c = 0; c < 12; ++c)
  {
    const double angle = 2 * pi * c / 12;
    for (const double z : { 0.0, height })
    {
      mesh.points.push_back({ radius * std::cos(angle), radius * std::sin(angle), z });
    }
    const Index next = (c + 1) % 12;
    mesh.triangles.push_back({ 2 * c, 2 * next, 2 * next + 1 });
    mesh.triangles.push_back({ 2 * c, 2 * next + 1, 2 * c + 1 });
  }
  return mesh;
}

/// Edges at both ends run along the rims of the cylinder.
ErrorFacet prismFacet(const BoundaryProjector& projector, const std::array<Point3, 3>& points)
{
  ErrorFacet facet = facetOf(projector, points);
  for (int k = 0; k < 3; ++k)
  {
    if (points[k][2] == points[(k + 1) % 3][2])
    {
      facet.edges[k] = { EdgeClass::OnEdge, -1 };
    }
  }
  return facet;
}

TEST(CylinderError, isTheVolumeDeficitOfAnInscribedPrism)
{
  const double radius = 1.5;
  const double height = 2;
  const auto model = cadtest::modelOf(cadtest::cylinder(radius, height));
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  const Mesh side = prismSide(radius, height);
  double volume = 0;
  double farthest = 0;
  for (const auto& [a, b, c] : side.triangles)
  {
    const FacetError error = cadtest::geometricError(
      projector, prismFacet(projector, { side.points[a], side.points[b], side.points[c] }), 4);
    volume += error.measure;
    farthest = std::max(farthest, error.largestDistance);
  }
  const double deficit = height * radius * radius * (pi - 6 * std::sin(2 * pi / 12));
  EXPECT_NEAR(volume, deficit, 0.01 * deficit);
  EXPECT_NEAR(farthest, radius * (1 - std::cos(pi / 12)), 1e-9);
}

TEST(PlaneError, isZero)
{
  const auto model = cadtest::modelOf(cadtest::rectangle(1, 1));
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  const FacetError error = cadtest::geometricError(
    projector, facetOf(projector, { { { 0.1, 0.1, 0 }, { 0.8, 0.2, 0 }, { 0.3, 0.9, 0 } } }), 3);
  EXPECT_LT(error.measure, 1e-15);
  EXPECT_LT(error.largestDistance, 1e-15);
}

/// Places on the CAD z = height(x, y).
auto placesOn(double (*height)(double, double))
{
  return [=](const std::vector<BoundaryEdge>& edges)
  {
    std::vector<ClosestPoint> places;
    for (const BoundaryEdge& edge : edges)
    {
      const Point3 middle = 0.5 * (edge.points[0] + edge.points[1]);
      ClosestPoint& place = places.emplace_back();
      place.entity = { 2, 0 };
      place.point = { middle[0], middle[1], height(middle[0], middle[1]) };
      place.distance = distance(place.point, middle);
    }
    return places;
  };
}

/// One facet, or a quadrilateral, whose corners are at these places on the CAD, or above them.
ClassifiedSurface surfaceOfOne(
  const std::vector<Point3>& places, const std::vector<double>& heights)
{
  ClassifiedSurface surface;
  surface.kind = places.size() == 2 ? BoundaryKind::Edges : BoundaryKind::Faces;
  SurfaceFacet facet;
  facet.quad = places.size() == 4 ? 0 : -1;
  for (std::size_t k = 0; k < places.size(); ++k)
  {
    SurfacePoint corner;
    corner.entity = { 2, 0 };
    corner.point = places[k] + heights[k] * Point3{ 0, 0, 1 };
    corner.place = places[k];
    corner.placeEntity = corner.entity;
    surface.points.push_back(corner);
    facet.corners[k] = static_cast<Index>(k);
    if (places.size() > 2 || k == 0)
    {
      const auto next = static_cast<Index>((k + 1) % places.size());
      surface.edges.push_back({ { static_cast<Index>(k), next }, { EdgeClass::Smooth, -1 } });
      facet.edges[k] = static_cast<Index>(k);
    }
  }
  surface.facets.push_back(facet);
  return surface;
}

double errorOn(double (*height)(double, double), const ClassifiedSurface& surface, int depth)
{
  const auto project = placesOn(height);
  return geometricErrors(surface, project(surface.allEdges()), depth, 1, project)[0].measure;
}

/// Over a triangle along both axes z = x^2 - y^2 is as much above the facet as below it: the
/// difference is (x - y) (x + y - 1), of which the integral is 0, and that of its absolute value
/// 1/24.
TEST(SaddleError, countsBothSides)
{
  const ClassifiedSurface surface =
    surfaceOfOne({ { 0, 0, 0 }, { 1, 0, 1 }, { 0, 1, -1 } }, { 0, 0, 0 });
  const auto saddle = [](double x, double y) { return x * x - y * y; };
  for (int depth = 1; depth <= 5; ++depth)
  {
    EXPECT_NEAR(errorOn(saddle, surface, depth), 1.0 / 24, 1e-12) << depth;
  }
}

/// A facet through the CAD z = 0, or a segment: on either side of the line where they cross.
TEST(CrossingError, countsBothSides)
{
  const auto error = [](const std::vector<Point3>& places, const std::vector<double>& heights)
  { return errorOn([](double, double) { return 0.0; }, surfaceOfOne(places, heights), 1); };
  // Two triangles with heights 1 and 1 at half of the length each.
  EXPECT_NEAR(error({ { 0, 0, 0 }, { 2, 0, 0 } }, { 1, -1 }), 1, 1e-12);
  EXPECT_NEAR(error({ { 0, 0, 0 }, { 2, 0, 0 } }, { 1, 1 }), 2, 1e-12);
  // Heights 1, 1, -2: a pyramid of base 2 x (2/3 of each side) below, as much above.
  const std::vector<Point3> triangle = { { 0, 0, 0 }, { 3, 0, 0 }, { 0, 3, 0 } };
  EXPECT_NEAR(error(triangle, { 1, 1, 1 }), 4.5, 1e-12);
  EXPECT_NEAR(error(triangle, { 1, 1, -2 }), 2 * (4.0 / 9) * 4.5 * 2 / 3, 1e-12);
  const std::vector<Point3> square = { { 0, 0, 0 }, { 2, 0, 0 }, { 2, 2, 0 }, { 0, 2, 0 } };
  EXPECT_NEAR(error(square, { 1, 1, -1, -1 }), 2, 1e-12);
}

/// An edge off the CAD stays straight: the facet's error does not follow it.
TEST(StraightEdges, haveNoError)
{
  const auto model = cadtest::modelOf(cadtest::sphere(1));
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  ErrorFacet facet = facetOf(projector, { { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } });
  const double whole = cadtest::geometricError(projector, facet, 1).measure;
  facet.edges = {};
  EXPECT_EQ(cadtest::geometricError(projector, facet, 1).measure, 0);
  facet.edges[0] = { EdgeClass::Smooth, -1 };
  const double one = cadtest::geometricError(projector, facet, 1).measure;
  EXPECT_GT(one, 0);
  EXPECT_LT(one, whole);
}

} // namespace
