// Classification on CAD models with creases and walls.

#include <cadrefine/classification/BoundaryProjector.h>

#include "TestShapes.h"

#include <cadrefine/cad/import/CADFile.h>
#include <cadrefine/classification/MidpointProjection.h>
#include <cadrefine/mesh/Quality.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{

using namespace cadrefine;

constexpr double unlimited = std::numeric_limits<double>::infinity();

FacetRecord facetWithNormal(const Vector3& normal)
{
  return { normalized(normal), 1, 1, 0, -1 };
}

ClassifiedFacet facetAt(const BoundaryProjector& projector, const std::array<Point3, 3>& points)
{
  ClassifiedFacet facet{ { points[0], points[1], points[2] }, {} };
  for (int k = 0; k < 3; ++k)
  {
    facet.entities[k] = projector.nearest(points[k], unlimited).entity;
  }
  return facet;
}

/// The unit box: faces, edges and corners at right angles.
class BoxProjector : public testing::Test
{
protected:
  std::shared_ptr<const CADModel> model = cadtest::modelOf(cadtest::box(1, 1, 1));
  BoundaryProjector projector{ *model, BoundaryKind::Faces };
  EdgeFinder edges{ *model };

  std::array<EntityId, 2> entitiesAt(const std::array<Point3, 2>& points) const
  {
    return { projector.nearest(points[0], unlimited).entity,
      projector.nearest(points[1], unlimited).entity };
  }
};

TEST_F(BoxProjector, knowsTheEightCorners)
{
  ASSERT_EQ(projector.corners().size(), 8u);
  for (const std::int32_t corner : projector.corners())
  {
    EXPECT_TRUE(projector.isCorner(corner));
  }
  EXPECT_FALSE(projector.isCorner(-1));
}

TEST_F(BoxProjector, findsTheNearestCrease)
{
  const ClosestPoint where = projector.nearestCrease({ 0.4, 0.2, 1.1 }, unlimited);
  EXPECT_EQ(where.entity.dimension, 1);
  EXPECT_NEAR(distance(where.point, { 0.4, 0, 1 }), 0, 1e-12);
  EXPECT_FALSE(projector.nearestCrease({ 0.5, 0.5, 1 }, 0.4).entity);
}

TEST_F(BoxProjector, putsMeshEdgesAlongSharpEdgesOntoThem)
{
  const std::vector<FacetRecord> facets{ facetWithNormal({ 0, -1, 0.1 }),
    facetWithNormal({ 0.1, 0, 1 }) };
  const EdgeMatch match =
    edges.find({ { { { 0.1, 0.02, 1.03 }, { 0.6, -0.02, 0.98 } } }, { facets[0], facets[1] } });
  const std::array<Point3, 2> points{ { { 0.1, 0, 1 }, { 0.6, 0, 1 } } };
  const EdgeClass edgeClass = projector.classify(points, entitiesAt(points), facets);
  ASSERT_EQ(edgeClass.kind, EdgeClass::OnEdge);
  EXPECT_EQ((EntityId{ 1, edgeClass.entity }), entitiesAt(points)[0]);
  EXPECT_EQ(match.edge, edgeClass.entity);
  const ClosestPoint where = projectMidpoint(projector, { edgeClass, points, entitiesAt(points) });
  EXPECT_EQ(where.entity.dimension, 1);
  EXPECT_NEAR(distance(where.point, { 0.35, 0, 1 }), 0, 1e-12);
}

TEST_F(BoxProjector, doesNotTakeFlatMeshEdgesForCreases)
{
  const std::vector<FacetRecord> flat{ facetWithNormal({ 0, 0, 1 }),
    facetWithNormal({ 0.02, 0, 1 }) };
  EXPECT_EQ(edges.find({ { { { 0.1, 0, 1 }, { 0.6, 0, 1 } } }, { flat[0], flat[1] } }).edge, -1);
  const std::array<Point3, 2> diagonal{ { { 0, 0, 1 }, { 1, 1, 1 } } };
  const EdgeClass edgeClass = projector.classify(diagonal, entitiesAt(diagonal), flat);
  EXPECT_EQ(edgeClass.kind, EdgeClass::Smooth);
  const ClosestPoint where =
    projectMidpoint(projector, { edgeClass, diagonal, entitiesAt(diagonal) });
  EXPECT_EQ(where.entity.dimension, 2);
  EXPECT_NEAR(distance(where.point, { 0.5, 0.5, 1 }), 0, 1e-12);
}

/// A mesh edge that leaves a crease at an angle of more than 60 degrees.
TEST_F(BoxProjector, doesNotTakeEdgesAwayFromACreaseForIt)
{
  const std::vector<FacetRecord> facets{ facetWithNormal({ 0, -1, 0.5 }),
    facetWithNormal({ 0, 0, 1 }) };
  EXPECT_EQ(
    edges.find({ { { { 0.4, 0, 1 }, { 0.5, 0.3, 1 } } }, { facets[0], facets[1] } }).edge, -1);
}

/// Where more than two facets meet, as at a baffle, their order does not matter.
TEST_F(BoxProjector, takesEveryPairOfFacetsForACrease)
{
  std::vector<FacetRecord> facets{ facetWithNormal({ 0, 0, 1 }), facetWithNormal({ 0.02, 0, 1 }),
    facetWithNormal({ 0, -1, 0 }) };
  const std::array<Point3, 2> points{ { { 0.1, 0, 1 }, { 0.6, 0, 1 } } };
  const std::int32_t edge = entitiesAt(points)[0].index;
  for (int turn = 0; turn < 3; ++turn)
  {
    EXPECT_EQ(edges.findCrease(meshEdges(points, facets)).edge, edge);
    EXPECT_EQ(projector.classify(points, entitiesAt(points), facets).entity, edge);
    std::rotate(facets.begin(), facets.begin() + 1, facets.end());
  }
}

TEST_F(BoxProjector, knowsACornersEdgesApart)
{
  const std::vector<FacetRecord> facets{ facetWithNormal({ 0, -1, 0 }),
    facetWithNormal({ 0, 0, 1 }) };
  const std::array<Point3, 2> points{ { { 0, 0, 1 }, { 1, 0, 1 } } };
  const auto entities = entitiesAt(points);
  ASSERT_EQ(entities[0].dimension, 0);
  const EdgeClass edgeClass = projector.classify(points, entities, facets);
  const ClosestPoint where = projectMidpoint(projector, { edgeClass, points, entities });
  EXPECT_EQ(edgeClass.kind, EdgeClass::OnEdge);
  EXPECT_EQ(edgeClass.entity, where.entity.index);
  EXPECT_NEAR(distance(where.point, { 0.5, 0, 1 }), 0, 1e-12);
}

TEST_F(BoxProjector, leavesEdgesBesideFreeFacetsAndOffTheCadStraight)
{
  const std::array<Point3, 2> points{ { { 0.1, 0, 1 }, { 0.6, 0, 1 } } };
  std::vector<FacetRecord> facets{ facetWithNormal({ 0, -1, 0 }), facetWithNormal({ 0, 0, 1 }) };
  EXPECT_EQ(projector.classify(points, {}, facets).kind, EdgeClass::Straight);
  EXPECT_EQ(projector.classify(points, entitiesAt(points), {}).kind, EdgeClass::Straight);
  facets[1] = { facets[1].normal, 1, 0, 1, -1 };
  EXPECT_EQ(projector.classify(points, entitiesAt(points), facets).kind, EdgeClass::Straight);
  EXPECT_FALSE(projectMidpoint(projector, { {}, points, entitiesAt(points) }).entity);
}

/// Walls meet the CAD at an edge: their normals do not fit it there.
TEST(WallFacets, areNotOnTheCad)
{
  const auto model = cadtest::modelOf(cadtest::rectangle(1, 1));
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  EXPECT_TRUE(projector.isOnCAD(
    facetAt(projector, { { { 0.1, 0, 0 }, { 0.5, 0, 0.02 }, { 0.3, 0.4, 0.01 } } })));
  EXPECT_FALSE(
    projector.isOnCAD(facetAt(projector, { { { 0.1, 0, 0 }, { 0.5, 0, 0 }, { 0.3, 0, 0.4 } } })));
  EXPECT_FALSE(projector.isOnCAD(
    facetAt(projector, { { { 0.1, 0.5, 0 }, { 0.5, 0.5, 0 }, { 0.3, 0.6, 0.4 } } })));
}

/// Curves and points that bound no face, which files hold beside bodies, are no part of these.
TEST(StrayCurve, isNoPartOfABody)
{
  const auto model = cadtest::modelOf(
    cadtest::together(cadtest::box(2, 2, 2), cadtest::moved(cadtest::circle(0.9), { 1, 1, 1 })));
  const Point3 beside{ 1.88, 1, 1 };
  const BoundaryProjector ofFaces(*model, BoundaryKind::Faces);
  EXPECT_NEAR(distance(ofFaces.nearest(beside, 1).point, { 2, 1, 1 }), 0, 1e-9);
  EXPECT_EQ(ofFaces.corners().size(), 8u);
  EXPECT_NEAR(ofFaces.nearestCrease(beside, 2).distance, std::hypot(0.12, 1), 1e-9);
  const ClosestPoint onCircle{ { 2, 0 }, { 1.9, 1, 1 }, {}, 0 };
  EXPECT_EQ(ofFaces.onSmallest(onCircle.point, 1e-6, onCircle).entity, onCircle.entity);
  EXPECT_NEAR(distance(model->nearest(beside).point, { 1.9, 1, 1 }), 0, 1e-9);
}

TEST(Pipe, hasNoCorners)
{
  const auto model = cadtest::modelOf(cadtest::pipe(1, 1.01, 1));
  EXPECT_TRUE(BoundaryProjector(*model, BoundaryKind::Faces).corners().empty())
    << "its circles close smoothly";
}

TEST(SharpWing, hasCornersAtTheEndsOfTheTrailingEdgeOnly)
{
  const auto model = readCADFile(CADREFINE_DATA "/naca0012_sharp.igs");
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  ASSERT_EQ(projector.corners().size(), 2u);
  for (const std::int32_t corner : projector.corners())
  {
    EXPECT_NEAR(model->nurbs().vertices[corner].point[0], 3, 1e-9);
  }
}

TEST(PlanarCurves, haveCornersWhereTheyMeetAtAnAngle)
{
  const auto model = readCADFile(CADREFINE_DATA "/three_arcs.igs");
  const BoundaryProjector projector(*model, BoundaryKind::Edges);
  EXPECT_EQ(projector.corners().size(), 3u);
  const auto circle = cadtest::modelOf(cadtest::circle(2), ".brep");
  EXPECT_TRUE(BoundaryProjector(*circle, BoundaryKind::Edges).corners().empty());
}

} // namespace
