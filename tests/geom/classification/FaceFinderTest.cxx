// Faces of facets, where parts are thin; corners, apexes and lines of creases.

#include <cadrefine/classification/FaceFinder.h>

#include "TestShapes.h"

#include <cadrefine/classification/CADAdjacency.h>
#include <cadrefine/classification/EdgeFinder.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace cadrefine;

Point3 at(double radius, double degrees, double z)
{
  const double angle = degrees * 3.14159265358979323846 / 180;
  return { radius * std::cos(angle), radius * std::sin(angle), z };
}

CornerHits hitsOf(const CADModel& model, const std::array<Point3, 3>& points)
{
  CornerHits facet{ { points[0], points[1], points[2] }, {} };
  for (int k = 0; k < 3; ++k)
  {
    facet.hits[k] = model.nearest(points[k]);
  }
  return facet;
}

/// A sheet of thickness 0.01, and a facet of its outer side whose corners are nearer to the inner
/// one. (No mesh edge of the outer side is that far off; but vertices that were moved are.)
class ThinSheetFaces : public testing::Test
{
protected:
  std::shared_ptr<const CADModel> model = cadtest::modelOf(cadtest::pipe(1, 1.01, 1));
  std::int32_t inner = model->nearest(at(0.99, 45, 0.5)).entity.index;
  std::int32_t outer = model->nearest(at(1.02, 45, 0.5)).entity.index;
  CornerHits facet = hitsOf(*model, { at(1, 40, 0.4), at(1, 50, 0.4), at(1, 45, 0.6) });

  FaceMatch find(std::int8_t side) const
  {
    return FaceFinder(*model, FaceSides(model->count(2), side)).find(facet);
  }
};

TEST_F(ThinSheetFaces, areFoundByTheSideOfTheFacet)
{
  ASSERT_EQ(facet.hits[0].entity, (EntityId{ 2, inner }));
  EXPECT_EQ(find(0).face, inner) << "nearest";
  EXPECT_EQ(find(-1).face, inner) << "a mesh inside the pipe";
  EXPECT_EQ(find(1).face, outer) << "a mesh of the sheet";
  EXPECT_TRUE(find(1).certain);
}

TEST_F(ThinSheetFaces, needNoQueryAmongTheirOwn)
{
  facet.amongItsOwn = { 0, 1, 0 };
  EXPECT_EQ(find(-1).face, inner);
  EXPECT_EQ(find(1).face, outer) << "but a normal that fits";
}

TEST_F(ThinSheetFaces, areNoneAcrossTheSheet)
{
  facet = hitsOf(*model, { at(0.9, 40, 0.5), at(1.1, 40, 0.5), at(1, 40.1, 0.6) });
  EXPECT_EQ(find(0).face, -1);
}

TEST(FaceSides, areThoseOfTheMajority)
{
  EXPECT_EQ(decideSides({ 9, 0, 2, 0 }, { 1, 8, 2, 0 }), (FaceSides{ 1, -1, 0, 0 }))
    << "half of all facets point either way";
  EXPECT_EQ(decideSides({ 9, 2, 0 }, { 1, 1, 0 }), (FaceSides{ 1, 1, 1 }))
    << "where a face does not know, most of all do";
}

TEST(Corners, areApexesToo)
{
  const auto cone = cadtest::modelOf(cadtest::cone(1, 2));
  const auto corners = findCorners(*cone);
  ASSERT_EQ(corners.size(), 1u) << "not the end of the seam on the smooth circle";
  EXPECT_NEAR(distance(cone->nurbs().vertices[corners[0]].point, { 0, 0, 2 }), 0, 1e-9);
  EXPECT_TRUE(findCorners(*cadtest::modelOf(cadtest::sphere(1))).empty()) << "poles are smooth";
  EXPECT_TRUE(findCorners(*cadtest::modelOf(cadtest::torus(2, 1))).empty());
}

TEST(CreaseLines, endAtCorners)
{
  const auto box = cadtest::modelOf(cadtest::box(1, 1, 1));
  const auto lines = findCreaseLines(box->nurbs(), findCorners(*box));
  for (std::int32_t edge = 0; edge < 12; ++edge)
  {
    EXPECT_EQ(lines[edge], edge);
  }
  EXPECT_EQ(findCreaseLines(box->nurbs(), {}), std::vector<std::int32_t>(12, 0));
}

/// A mesh edge along the seam of a cylinder belongs to it if it is close to it at both ends, and
/// they are not on the surface already.
TEST(Seams, areTakenWhereTheMeshFollowsThem)
{
  const auto model = cadtest::modelOf(cadtest::cylinder(1, 3));
  const EdgeFinder finder(*model);
  const std::int32_t face = model->nearest(at(1.1, 100, 1)).entity.index;
  const FacetRecord record{ { 1, 0, 0 }, 0.4, 1, 0, face };
  const auto edge = [&](double first, double second) {
    return MeshEdge{ { at(1.02, first, 1), at(0.97, second, 2) }, { record, record } };
  };
  const EdgeMatch match = finder.find(edge(2, -3));
  ASSERT_GE(match.edge, 0);
  EXPECT_TRUE(isSeam(model->nurbs().edges[match.edge]));
  EXPECT_EQ(finder.find(edge(2, 20)).edge, -1);
  MeshEdge settled = edge(2, -3);
  settled.settled[1] = 1;
  EXPECT_EQ(finder.find(settled).edge, -1);
}

} // namespace
