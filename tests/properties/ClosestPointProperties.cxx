// Closest points of random NURBS models.

#include "OccOracle.h"
#include "RandomShapes.h"
#include "Rounds.h"
#include "TestShapes.h"

#include <cadrefine/cad/extraction/ShapeIndex.h>
#include <cadrefine/cad/model/ModelBytes.h>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepTools.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Tool.hxx>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <sstream>
#include <thread>

namespace propertytest
{

namespace
{

using namespace cadrefine;

Point3 fromOcc(const gp_Pnt& p)
{
  return { p.X(), p.Y(), p.Z() };
}

void sampleEdge(const TopoDS_Edge& edge, std::vector<Point3>& samples)
{
  constexpr int n = 64;
  const BRepAdaptor_Curve curve(edge);
  for (int i = 0; i <= n; ++i)
  {
    const double part = static_cast<double>(i) / n;
    samples.push_back(
      fromOcc(curve.Value((1 - part) * curve.FirstParameter() + part * curve.LastParameter())));
  }
}

/// Points inside of the loops, by Open CASCADE's classifier.
void sampleFace(const TopoDS_Face& face, std::vector<Point3>& samples)
{
  constexpr int n = 32;
  const BRepAdaptor_Surface surface(face);
  BRepTopAdaptor_FClass2d classifier(face, BRep_Tool::Tolerance(face));
  double u0 = 0;
  double u1 = 0;
  double v0 = 0;
  double v1 = 0;
  BRepTools::UVBounds(face, u0, u1, v0, v1);
  for (int i = 0; i <= n; ++i)
  {
    for (int j = 0; j <= n; ++j)
    {
      const gp_Pnt2d uv(u0 + (u1 - u0) * i / n, v0 + (v1 - v0) * j / n);
      if (classifier.Perform(uv) == TopAbs_IN)
      {
        samples.push_back(fromOcc(surface.Value(uv.X(), uv.Y())));
      }
    }
  }
}

/// Points of the model, a thousand a face.
std::vector<Point3> denseSamples(const TopoDS_Shape& shape)
{
  const ShapeIndex index(shape);
  std::vector<Point3> samples;
  for (const TopoDS_Vertex& vertex : index.vertices())
  {
    samples.push_back(fromOcc(BRep_Tool::Pnt(vertex)));
  }
  for (const TopoDS_Edge& edge : index.edges())
  {
    sampleEdge(edge, samples);
  }
  for (const TopoDS_Face& face : index.faces())
  {
    sampleFace(face, samples);
  }
  return samples;
}

/// On the model, off it by any order of magnitude, about it, and far away.
std::vector<Point3> queryPoints(
  Random& random, const std::vector<Point3>& samples, double size, int count)
{
  const auto last = static_cast<int>(samples.size()) - 1;
  const auto anyVector = [&] {
    return Vector3{ random.between(-1, 1), random.between(-1, 1), random.between(-1, 1) };
  };
  std::vector<Point3> points;
  for (int i = 0; i < count; ++i)
  {
    const Point3& on = samples[random.among(0, last)];
    const double away = i % 4 == 0   ? 0
                        : i % 4 == 1 ? size * random.anyMagnitude(12)
                        : i % 4 == 2 ? size * random.between(0, 1)
                                     : size / random.anyMagnitude(3);
    points.push_back(on + away * anyVector());
  }
  return points;
}

/// A random model, as the reader makes it, and points to ask for.
struct Problem
{
  Problem(Random& random, ShapeKind kind, int points)
    : model(cadtest::modelOf(randomShape(random, kind), ".brep")),
      shape(decodeModel(model->toBytes()).shape), samples(denseSamples(shape)),
      queries(queryPoints(random, samples, model->size(), points))
  {
  }

  std::shared_ptr<const CADModel> model;
  TopoDS_Shape shape;
  std::vector<Point3> samples;
  std::vector<Point3> queries;
};

std::string describe(const Point3& point, const ClosestPoint& answer)
{
  std::ostringstream text;
  text.precision(17);
  text << "(" << point[0] << ", " << point[1] << ", " << point[2] << "): entity "
       << answer.entity.index << " of dimension " << static_cast<int>(answer.entity.dimension)
       << " at (" << answer.parameters[0] << ", " << answer.parameters[1] << "), "
       << answer.distance << " away";
  return text.str();
}

class ClosestPointProperty : public testing::TestWithParam<ShapeKind>
{
};

INSTANTIATE_TEST_SUITE_P(Random, ClosestPointProperty, testing::ValuesIn(shapeKinds),
  [](const auto& kind) { return nameOf(kind.param); });

/// Compares answers of one problem with Open CASCADE's and with samples.
class BruteForce
{
public:
  explicit BruteForce(const Problem& problem)
    : problem_(problem), size_(problem.model->size()), index_(problem.shape),
      oracle_(problem.shape, size_)
  {
  }

  /// The answer is a point of the model, where it says, and no point known is nearer by more than
  /// 1e-9 of the size.
  void expectNearest(const Point3& q, const ClosestPoint& answer) const
  {
    const double tolerance = 1e-9 * size_;
    ASSERT_TRUE(answer.entity) << describe(q, answer);
    const Point3 there = problem_.model->evaluate(answer.entity, answer.parameters);
    EXPECT_LE(distance(there, answer.point), 1e-12 * size_) << describe(q, answer);
    EXPECT_NEAR(distance(q, answer.point), answer.distance, 1e-12 * (size_ + answer.distance))
      << describe(q, answer);
    EXPECT_LE(answer.distance, sampledDistance(q) + tolerance) << describe(q, answer);
    const auto expected = oracle_.nearest(q, answer.distance + tolerance);
    EXPECT_LE(answer.distance, expected.distance + tolerance) << describe(q, answer);
    EXPECT_TRUE(liesOnShape(answer, tolerance)) << describe(q, answer);
  }

private:
  /// Of an edge, at or near the same parameter: Open CASCADE's projections miss some points of
  /// closed edges and of those of high degree.
  bool liesOnShape(const ClosestPoint& answer, double tolerance) const
  {
    return answer.entity.dimension == 1
             ? distanceToCurve(BRepAdaptor_Curve(index_.edges()[answer.entity.index]),
                 answer.parameters[0], answer.point, tolerance) <= tolerance
             : oracle_.liesOn(answer.entity, answer.point, tolerance);
  }

  /// By Gauss-Newton steps from `parameter`, where the point is but on circles: our arcs are
  /// rational, and their parameter is the angle at their ends only.
  static double distanceToCurve(
    const BRepAdaptor_Curve& curve, double parameter, const Point3& p, double tolerance)
  {
    double away = distance(fromOcc(curve.Value(parameter)), p);
    for (int step = 0; step < 20 && away > tolerance; ++step)
    {
      gp_Pnt at;
      gp_Vec along;
      curve.D1(parameter, at, along);
      const double change = gp_Vec(at, { p[0], p[1], p[2] }).Dot(along) / along.SquareMagnitude();
      parameter = std::clamp(parameter + change, curve.FirstParameter(), curve.LastParameter());
      away = distance(fromOcc(curve.Value(parameter)), p);
    }
    return away;
  }

  double sampledDistance(const Point3& q) const
  {
    double least = std::numeric_limits<double>::infinity();
    for (const Point3& sample : problem_.samples)
    {
      least = std::min(least, distance(q, sample));
    }
    return least;
  }

  const Problem& problem_;
  double size_;
  ShapeIndex index_;
  exacttest::OccOracle oracle_;
};

/// Also of the queries that reach the work limit, of which there are very few: trim curves lie off
/// their edges, and where the face's border is nearest along a stretch of them, it is cut up.
TEST_P(ClosestPointProperty, isThatOfBruteForce)
{
  int queries = 0;
  int gaveUp = 0;
  forEachSeed(10,
    [&](Random& random)
    {
      const Problem problem(random, GetParam(), 40);
      const BruteForce bruteForce(problem);
      for (const Point3& q : problem.queries)
      {
        const ClosestPoint answer = problem.model->nearest(q);
        bruteForce.expectNearest(q, answer);
        ++queries;
        gaveUp += answer.converged ? 0 : 1;
      }
    });
  RecordProperty("queries", queries);
  RecordProperty("gave_up", gaveUp);
  EXPECT_LE(gaveUp, 1 + queries / 1000);
}

using Bits = std::array<std::uint64_t, 8>;

Bits bitsOf(const ClosestPoint& answer)
{
  const std::array<double, 8> numbers{ answer.point[0], answer.point[1], answer.point[2],
    answer.parameters[0], answer.parameters[1], answer.distance,
    static_cast<double>(answer.entity.index), static_cast<double>(answer.entity.dimension) };
  Bits bits{};
  std::memcpy(bits.data(), numbers.data(), sizeof(bits));
  return bits;
}

std::vector<Bits> askInOrder(
  const CADModel& model, const std::vector<Point3>& points, const std::vector<std::size_t>& order)
{
  std::vector<Bits> answers(points.size());
  for (const std::size_t i : order)
  {
    answers[i] = bitsOf(model.nearest(points[i]));
  }
  return answers;
}

/// Bit for bit the same in any order, on any thread, and of a model that was sent as bytes.
TEST_P(ClosestPointProperty, dependsOnPointAndModelAlone)
{
  forEachSeed(12,
    [](Random& random)
    {
      const Problem problem(random, GetParam(), 120);
      std::vector<std::size_t> order(problem.queries.size());
      std::iota(order.begin(), order.end(), std::size_t{ 0 });
      const auto expected = askInOrder(*problem.model, problem.queries, order);
      const auto sent = CADModel::fromBytes(problem.model->toBytes());
      std::vector<std::vector<Bits>> answers(3);
      std::vector<std::thread> threads;
      for (std::vector<Bits>& of : answers)
      {
        std::shuffle(order.begin(), order.end(), random.engine());
        threads.emplace_back(
          [&of, &sent, &problem, order] { of = askInOrder(*sent, problem.queries, order); });
      }
      for (std::thread& thread : threads)
      {
        thread.join();
      }
      for (const std::vector<Bits>& of : answers)
      {
        EXPECT_TRUE(of == expected);
      }
    });
}

/// A limit that is larger than the distance does not change the answer.
TEST_P(ClosestPointProperty, doesNotDependOnALimitBeyondIt)
{
  forEachSeed(12,
    [](Random& random)
    {
      const Problem problem(random, GetParam(), 120);
      for (const Point3& q : problem.queries)
      {
        const ClosestPoint answer = problem.model->nearest(q);
        SearchScope scope;
        scope.maximumDistance =
          (1 + random.between(0, 2)) * answer.distance + 1e-9 * problem.model->size();
        EXPECT_EQ(bitsOf(problem.model->nearest(q, scope)), bitsOf(answer))
          << describe(q, answer) << "; limit " << scope.maximumDistance;
      }
    });
}

NurbsModel scaled(NurbsModel model, double factor)
{
  const auto scalePoints = [factor](std::vector<ControlPoint>& points)
  {
    for (ControlPoint& point : points)
    {
      point = { factor * point[0], factor * point[1], factor * point[2], point[3] };
    }
  };
  for (NurbsFace& face : model.faces)
  {
    face.tolerance *= factor;
    for (BezierPatch& patch : face.patches)
    {
      scalePoints(patch.points);
    }
    for (TrimLoop& loop : face.loops)
    {
      for (BezierCurve2& curve : loop)
      {
        curve.deviation *= factor;
      }
    }
  }
  for (NurbsEdge& edge : model.edges)
  {
    edge.tolerance *= factor;
    for (BezierCurve& segment : edge.segments)
    {
      scalePoints(segment.points);
    }
  }
  for (NurbsVertex& vertex : model.vertices)
  {
    vertex.tolerance *= factor;
    vertex.point = factor * vertex.point;
  }
  return model;
}

/// Powers of two scale without rounding: then so does the answer, bit for bit. An absolute
/// tolerance anywhere would show.
TEST_P(ClosestPointProperty, scalesWithPowersOfTwo)
{
  forEachSeed(12,
    [](Random& random)
    {
      const Problem problem(random, GetParam(), 120);
      const int exponent = random.among(-50, 60);
      const double factor = std::ldexp(1.0, exponent);
      const NurbsModel& model = problem.model->nurbs();
      const NurbsModel scaledModel = scaled(model, factor);
      const ClosestPointSearch search(model);
      const ClosestPointSearch scaledSearch(scaledModel);
      EXPECT_EQ(scaledSearch.modelSize(), factor * search.modelSize());
      for (const Point3& q : problem.queries)
      {
        ClosestPoint expected = search.nearest(q);
        const ClosestPoint answer = scaledSearch.nearest(factor * q);
        EXPECT_EQ(answer.converged, expected.converged);
        expected.point = factor * expected.point;
        expected.distance *= factor;
        EXPECT_EQ(bitsOf(answer), bitsOf(expected))
          << describe(factor * q, answer) << "\nexpected " << describe(factor * q, expected)
          << "\nscale 2^" << exponent;
      }
    });
}

} // namespace

} // namespace propertytest
