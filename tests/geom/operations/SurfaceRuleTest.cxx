// Changes of the boundary on the CAD: a sphere, whose distances are closed forms.

#include "TestShapes.h"

#include <cadrefine/mesh/Quality.h>
#include <cadrefine/operations/Operations.h>
#include <cadrefine/operations/SurfaceRule.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{

using namespace cadrefine;

/// Away from the poles and the seam.
Point3 onSphere(double x, double y)
{
  return { -std::sqrt(1 - x * x - y * y), -x, y };
}

/// Four vertices of the unit sphere at (+-x, 0) and (0, +-y), and its centre: two cells
/// with a facet each that meet in the edge between the first two.
EditableMesh cap(double x, double y)
{
  EditableMesh mesh;
  for (const Point3& point : { onSphere(x, 0), onSphere(-x, 0), onSphere(0, y), onSphere(0, -y) })
  {
    mesh.addVertex({ point, point, { 2, 0 }, false, false });
  }
  mesh.addVertex({ {}, {}, {}, false, true });
  mesh.addCell({ { 0, 2, 1, 4 }, 0, 0 });
  mesh.addCell({ { 0, 1, 3, 4 }, 0, 1 });
  for (Index cell : { 0, 1 })
  {
    auto corners = mesh.cells()[cell].corners;
    if (!mesh.isValid(corners))
    {
      std::swap(corners[0], corners[1]);
      mesh.replace({ { cell }, {}, {}, { { corners, 0, cell } }, {}, {} });
    }
  }
  mesh.addFacet({ { 0, 2, 1 }, 0, -1 });
  mesh.addFacet({ { 0, 1, 3 }, 0, -1 });
  return mesh;
}

class SurfaceRules : public testing::Test
{
protected:
  std::shared_ptr<const CADModel> model = cadtest::modelOf(cadtest::sphere(1));
  BoundaryProjector projector{ *model, BoundaryKind::Faces };
  SurfaceRule rule{ projector };
};

TEST_F(SurfaceRules, fitIsThatOfASphere)
{
  const EditableMesh mesh = cap(0.3, 0.2);
  const auto fit = rule.fitOf(mesh, { 0 });
  double largest = 0;
  const auto& corners = mesh.facets()[0].corners;
  Point3 sum{};
  for (int k = 0; k < 3; ++k)
  {
    const Point3& a = mesh.vertex(corners[k]).point;
    const Point3& b = mesh.vertex(corners[(k + 1) % 3]).point;
    largest = std::max(largest, 1 - norm(0.5 * (a + b)));
    sum = sum + a;
  }
  largest = std::max(largest, 1 - norm((1.0 / 3) * sum));
  double cosine = 1;
  for (int k = 0; k < 3; ++k)
  {
    const Point3 middle =
      0.5 * (mesh.vertex(corners[k]).point + mesh.vertex(corners[(k + 1) % 3]).point);
    const Vector3 normal = twofoldAreaVector(
      mesh.vertex(corners[0]).point, mesh.vertex(corners[1]).point, mesh.vertex(corners[2]).point);
    cosine = std::min(cosine, std::abs(dot(normalized(middle), normalized(normal))));
  }
  EXPECT_NEAR(fit.cosine, cosine, 1e-7);
  EXPECT_NEAR(fit.distance, largest, 1e-9);
}

TEST_F(SurfaceRules, acceptsTheShorterDiagonalAlone)
{
  Cavity cavity;
  const EditableMesh longer = cap(0.3, 0.2);
  ASSERT_TRUE(proposeEdgeRemoval(longer, 0, 1, cavity));
  EXPECT_TRUE(rule.accepts(longer, cavity));
  const EditableMesh shorter = cap(0.2, 0.3);
  ASSERT_TRUE(proposeEdgeRemoval(shorter, 0, 1, cavity));
  EXPECT_FALSE(rule.accepts(shorter, cavity));
}

TEST_F(SurfaceRules, putsTheMiddleOfAnEdgeOntoTheSphere)
{
  EditableMesh mesh = cap(0.3, 0.2);
  const ClosestPoint where = rule.placeOfMiddle(mesh, 0, 1).value();
  EXPECT_EQ(where.entity, (EntityId{ 2, 0 }));
  EXPECT_NEAR(distance(where.point, { -1, 0, 0 }), 0, 1e-9);
  mesh.addSegment({ { 0, 1 }, -1, -1 });
  EXPECT_FALSE(rule.placeOfMiddle(mesh, 0, 1)); // a crease that is on no CAD edge
}

/// Both pairs of facets are under the same part of the sphere, so that the error differs by the
/// volume between the pairs: that of the tetrahedron of the four vertices.
TEST_F(SurfaceRules, errorGainIsTheVolumeBetweenTheFacets)
{
  for (const double scale : { 1.0, 0.5, 0.25 })
  {
    const EditableMesh mesh = cap(0.3 * scale, 0.2 * scale);
    Cavity cavity;
    ASSERT_TRUE(proposeEdgeRemoval(mesh, 0, 1, cavity));
    const auto at = [&](Index v) { return mesh.vertex(v).point; };
    const double volume = std::abs(sixfoldVolume(at(0), at(1), at(2), at(3))) / 6;
    EXPECT_NEAR(rule.errorGain(mesh, cavity), -volume, 0.05 * volume) << scale;
    EXPECT_TRUE(rule.accepts(mesh, cavity, { 0, true }));
  }
}

/// Where the facets end, there are others beyond, in other blocks: the surface goes on.
TEST_F(SurfaceRules, rimsOfFacetsAreOnTheSphere)
{
  const EditableMesh open = cap(0.3, 0.2);
  EditableMesh closed = open;
  closed.closeFacets();
  Cavity cavity;
  ASSERT_TRUE(proposeEdgeRemoval(closed, 0, 1, cavity));
  ASSERT_EQ(closed.segments().size(), 4U);
  EXPECT_EQ(rule.errorGain(closed, cavity), rule.errorGain(open, cavity));
  EXPECT_EQ(rule.fitOf(closed, { 0 }).cosine, rule.fitOf(open, { 0 }).cosine);
}

/// Facets off the CAD are exchanged for others in their plane where that is allowed.
TEST_F(SurfaceRules, wallsChangeInTheirPlaneAlone)
{
  for (const double height : { 0.0, 0.1 })
  {
    EditableMesh mesh;
    for (const Point3& point :
      { Point3{ 0, 0, 0 }, Point3{ 1, 0, 0 }, Point3{ 1, 1, height }, Point3{ 0, 1, 0 } })
    {
      mesh.addVertex({ point, point, {}, false, false });
    }
    mesh.addVertex({ { 0.5, 0.5, -1 }, { 0.5, 0.5, -1 }, {}, false, true });
    mesh.addCell({ { 4, 0, 1, 2 }, 0, 0 });
    mesh.addCell({ { 4, 0, 2, 3 }, 0, 1 });
    mesh.addFacet({ { 0, 1, 2 }, -2, -1 });
    mesh.addFacet({ { 0, 2, 3 }, -2, -1 });
    Cavity cavity;
    ASSERT_TRUE(proposeEdgeRemoval(mesh, 0, 2, cavity));
    EXPECT_FALSE(rule.accepts(mesh, cavity, { 0, false, SurfaceLimits::Walls::Stay }));
    EXPECT_EQ(rule.accepts(mesh, cavity), height == 0);
  }
}

} // namespace
