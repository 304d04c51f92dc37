// Where vertices go that stopped on their way to the CAD.

#include <cadrefine/motion/MovesOntoCAD.h>

#include "TestShapes.h"

#include <cadrefine/cad/import/CADFile.h>

#include <gtest/gtest.h>

#include <limits>

namespace cadrefine
{
namespace
{

TEST(MovesOntoCAD, keepThePlaceInAFaceWhoseBorderIsNearer)
{
  const auto model = cadtest::modelOf(cadtest::box(1, 1, 1));
  const BoundaryProjector projector(*model, BoundaryKind::Faces);
  const ClosestPoint place =
    projector.nearest({ 0.9, 0.5, 1 }, std::numeric_limits<double>::infinity());
  ASSERT_EQ(place.entity.dimension, 2);
  const struct
  {
    Point3 point;
    Point3 target;
  } cases[] = { { { 0.7, 0.5, 1.1 }, { 0.7, 0.5, 1 } }, { { 1.2, 0.5, 1.1 }, { 0.9, 0.5, 1 } } };
  for (const auto& [point, target] : cases)
  {
    Mesh mesh;
    mesh.points = { point };
    Classification classification(1);
    classification.set(0, place);
    classification.distances[0] = distance(point, place.point);
    const Moves moves = movesOntoCAD(mesh, projector, classification);
    EXPECT_EQ(classification.entities[0], place.entity);
    EXPECT_NEAR(distance(moves.targets[0], target), 0, 1e-12);
  }
}

} // namespace
} // namespace cadrefine
