// Real files of Debian packages (occt-misc, libdeal.ii-doc), against Open CASCADE's own distances.

#include <cadrefine/cad/extraction/ShapeIndex.h>
#include <cadrefine/cad/import/CADFile.h>
#include <cadrefine/cad/model/ModelBytes.h>

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepClass_FaceClassifier.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <Bnd_Box.hxx>

#include <gtest/gtest.h>

#include <ostream>
#include <random>

namespace
{

using namespace cadrefine;

struct RealFile
{
  const char* name;
  const char* path;
  int faces;
  const char* unit;
};

void PrintTo(const RealFile& tried, std::ostream* out)
{
  *out << tried.name;
}

class RealFiles : public testing::TestWithParam<RealFile>
{
};

INSTANTIATE_TEST_SUITE_P(Debian, RealFiles,
  testing::Values(RealFile{ "bearing", "/usr/share/opencascade/data/iges/bearing.iges", 213, "mm" },
    RealFile{ "hammer", "/usr/share/opencascade/data/iges/hammer.iges", 45, "mm" },
    RealFile{ "linkrods", "/usr/share/opencascade/data/step/linkrods.step", 37, "mm" },
    RealFile{ "bow",
      "/usr/share/doc/libdeal.ii-doc/examples/step-54/input/DTMB-5415_bulbous_bow.iges", 1, "m" }),
  [](const auto& file) { return std::string(file.param.name); });

std::vector<Point3> randomPoints(const TopoDS_Shape& shape, int count)
{
  Bnd_Box box;
  BRepBndLib::Add(shape, box, false);
  const gp_Pnt low = box.CornerMin();
  const gp_Pnt high = box.CornerMax();
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> part(-0.2, 1.2);
  std::vector<Point3> points(count);
  for (Point3& p : points)
  {
    for (int k = 0; k < 3; ++k)
    {
      const double a = low.Coord(k + 1);
      p[k] = a + part(generator) * (high.Coord(k + 1) - a);
    }
  }
  return points;
}

gp_Pnt toOcc(const Point3& p)
{
  return { p[0], p[1], p[2] };
}

double distanceByOcc(const Point3& p, const TopoDS_Shape& shape)
{
  const BRepExtrema_DistShapeShape extrema(BRepBuilderAPI_MakeVertex(toOcc(p)).Vertex(), shape);
  return extrema.IsDone() ? extrema.Value() : std::numeric_limits<double>::infinity();
}

/// True where the answer lies on the trimmed model also by Open CASCADE's classification.
bool liesOnModel(const ClosestPoint& answer, const ShapeIndex& index, double tolerance)
{
  if (answer.entity.dimension == 2)
  {
    const TopoDS_Face& face = index.faces()[answer.entity.index];
    const BRepClass_FaceClassifier classifier(face, toOcc(answer.point), tolerance);
    return classifier.State() == TopAbs_IN || classifier.State() == TopAbs_ON;
  }
  const TopoDS_Shape shape = answer.entity.dimension == 1
                               ? TopoDS_Shape(index.edges()[answer.entity.index])
                               : TopoDS_Shape(index.vertices()[answer.entity.index]);
  return distanceByOcc(answer.point, shape) <= tolerance;
}

TEST_P(RealFiles, isReadWhole)
{
  const auto model = readCADFile(GetParam().path);
  EXPECT_EQ(model->count(2), GetParam().faces);
  EXPECT_EQ(model->unit(), GetParam().unit);
  EXPECT_TRUE(model->unread().empty());
  for (const NurbsEdge& edge : model->nurbs().edges)
  {
    EXPECT_FALSE(edge.faces.empty());
    EXPECT_FALSE(edge.segments.empty());
  }
}

TEST_P(RealFiles, distancesAgreeWithOpenCASCADE)
{
  const auto model = readCADFile(GetParam().path);
  const TopoDS_Shape shape = decodeModel(model->toBytes()).shape;
  const ShapeIndex index(shape);
  const double tolerance = 1e-9 * model->size();
  int nearer = 0;
  for (const Point3& p : randomPoints(shape, 200))
  {
    const ClosestPoint answer = model->nearest(p);
    const double expected = distanceByOcc(p, shape);
    EXPECT_TRUE(answer.converged);
    EXPECT_LE(answer.distance, expected + tolerance)
      << p[0] << " " << p[1] << " " << p[2] << " dimension " << int(answer.entity.dimension)
      << " index " << answer.entity.index;
    EXPECT_NEAR(distance(answer.point, p), answer.distance, tolerance);
    if (answer.distance < expected - tolerance)
    {
      ++nearer;
      EXPECT_TRUE(liesOnModel(answer, index, 1e-7 * model->size()))
        << p[0] << " " << p[1] << " " << p[2] << ": " << answer.distance << " < " << expected;
    }
  }
  RecordProperty("nearer_than_open_cascade", nearer);
}

} // namespace
