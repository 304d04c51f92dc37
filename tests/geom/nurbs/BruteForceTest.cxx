// Bumpy rational bicubic faces against a dense search.
#include "Reference.h"
#include "Shapes.h"

#include <gtest/gtest.h>

namespace cadrefine
{
namespace
{

void compare(const NurbsModel& model, int points, double scale, std::uint64_t seed)
{
  const ClosestPointSearch search(model);
  const double size = search.modelSize();
  shapes::Random random(seed);
  for (int i = 0; i < points; ++i)
  {
    const Point3 q = Point3{ 1.0, 1.0, 0.0 } + random.point(scale);
    const ClosestPoint answer = search.nearest(q);
    reference::expectConsistent(model, size, q, answer);
    EXPECT_TRUE(answer.converged);
    EXPECT_LE(answer.distance, reference::faceDistance(model.faces[0], q) + 1e-9 * size);
  }
}

TEST(BruteForce, nearPoints)
{
  compare(shapes::modelOf(shapes::bumpyFace(2, 0.5, 11)), 700, 1.2, 12);
}

TEST(BruteForce, farPoints)
{
  compare(shapes::modelOf(shapes::bumpyFace(2, 1.0, 13)), 500, 6.0, 14);
}

TEST(BruteForce, foldedFace)
{
  compare(shapes::modelOf(shapes::bumpyFace(1, 3.0, 15)), 500, 2.0, 16);
}

TEST(BruteForce, pointsOfTheFaceAreFound)
{
  const NurbsModel model = shapes::modelOf(shapes::bumpyFace(4, 0.7, 17));
  const ClosestPointSearch search(model);
  shapes::Random random(18);
  for (int i = 0; i < 5000; ++i)
  {
    const std::array<double, 2> at = { 2.0 + 2.0 * random(), 2.0 + 2.0 * random() };
    const Point3 q = reference::evaluateOn(model, { 2, 0 }, at);
    EXPECT_LE(search.nearest(q).distance, 1e-9 * search.modelSize());
  }
}

} // namespace
} // namespace cadrefine
