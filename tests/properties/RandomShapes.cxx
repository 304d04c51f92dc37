#include "RandomShapes.h"

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepLib.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRep_Builder.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_Circle.hxx>
#include <Geom2d_Line.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Precision.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TColgp_Array1OfPnt2d.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Wire.hxx>
#include <gp.hxx>
#include <gp_Trsf.hxx>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace propertytest
{

namespace
{

/// Clamped knots over [0, 1].
struct Knots
{
  int degree = 1;
  std::vector<double> values;
  std::vector<int> multiplicities;

  int poleCount() const
  {
    int sum = -degree - 1;
    for (const int multiplicity : multiplicities)
    {
      sum += multiplicity;
    }
    return sum;
  }
};

Knots randomKnots(Random& random)
{
  Knots knots;
  knots.degree = random.chance(0.1) ? random.among(6, 9) : random.among(1, 5);
  const int spans = random.among(1, 4);
  knots.values = { 0, 1 };
  for (int k = 1; k < spans; ++k)
  {
    knots.values.push_back((k + random.between(-0.45, 0.45)) / spans);
  }
  std::sort(knots.values.begin(), knots.values.end());
  for (std::size_t k = 0; k < knots.values.size(); ++k)
  {
    const bool isEnd = k == 0 || k + 1 == knots.values.size();
    const int inside = random.chance(0.2) ? random.among(1, knots.degree) : 1;
    knots.multiplicities.push_back(isEnd ? knots.degree + 1 : inside);
  }
  return knots;
}

TColStd_Array1OfReal valuesOf(const Knots& knots)
{
  TColStd_Array1OfReal values(1, static_cast<int>(knots.values.size()));
  std::copy(knots.values.begin(), knots.values.end(), values.begin());
  return values;
}

TColStd_Array1OfInteger multiplicitiesOf(const Knots& knots)
{
  TColStd_Array1OfInteger values(1, static_cast<int>(knots.multiplicities.size()));
  std::copy(knots.multiplicities.begin(), knots.multiplicities.end(), values.begin());
  return values;
}

struct Pole
{
  gp_Pnt point;
  double weight = 1;
};

double randomWeight(Random& random)
{
  return std::exp(random.between(-0.7, 0.7));
}

Handle(Geom_BSplineSurface)
  surfaceOf(const Knots& u, const Knots& v, const std::function<Pole(int, int)>& pole)
{
  TColgp_Array2OfPnt points(1, u.poleCount(), 1, v.poleCount());
  TColStd_Array2OfReal weights(1, u.poleCount(), 1, v.poleCount());
  for (int i = 0; i < u.poleCount(); ++i)
  {
    for (int j = 0; j < v.poleCount(); ++j)
    {
      const Pole each = pole(i, j);
      points(i + 1, j + 1) = each.point;
      weights(i + 1, j + 1) = each.weight;
    }
  }
  return new Geom_BSplineSurface(points, weights, valuesOf(u), valuesOf(v), multiplicitiesOf(u),
    multiplicitiesOf(v), u.degree, v.degree);
}

Handle(Geom_BSplineCurve) curveOf(const Knots& knots, const std::function<Pole(int)>& pole)
{
  TColgp_Array1OfPnt points(1, knots.poleCount());
  TColStd_Array1OfReal weights(1, knots.poleCount());
  for (int i = 0; i < knots.poleCount(); ++i)
  {
    const Pole each = pole(i);
    points(i + 1) = each.point;
    weights(i + 1) = each.weight;
  }
  return new Geom_BSplineCurve(
    points, weights, valuesOf(knots), multiplicitiesOf(knots), knots.degree);
}

/// A hilly sheet over a rectangle.
Handle(Geom_BSplineSurface) randomSurface(Random& random)
{
  const Knots u = randomKnots(random);
  const Knots v = randomKnots(random);
  const double width = random.between(0.4, 1.5);
  const double height = random.between(0.4, 1.5);
  const double hills = random.between(0, 0.6);
  const bool isRational = random.chance(0.7);
  const double stepU = width / (u.poleCount() - 1);
  const double stepV = height / (v.poleCount() - 1);
  return surfaceOf(u, v,
    [&](int i, int j)
    {
      const double x = stepU * (i + random.between(-0.3, 0.3));
      const double y = stepV * (j + random.between(-0.3, 0.3));
      const double z = hills * random.between(-1, 1);
      return Pole{ gp_Pnt(x, y, z), isRational ? randomWeight(random) : 1 };
    });
}

TopoDS_Face faceOf(const Handle(Geom_Surface) & surface)
{
  return BRepBuilderAPI_MakeFace(surface, Precision::Confusion()).Face();
}

TopoDS_Edge edgeOn(
  const Handle(Geom_Surface) & surface, const Handle(Geom2d_Curve) & curve, double t0, double t1)
{
  TopoDS_Edge edge = BRepBuilderAPI_MakeEdge(curve, surface, t0, t1).Edge();
  if (!BRepLib::BuildCurve3d(edge))
  {
    throw std::runtime_error("the generator cannot make a trim curve in space");
  }
  return edge;
}

/// At least four, in the order of their directions.
std::vector<gp_Pnt2d> cornersRound(Random& random, const gp_Pnt2d& centre, double low, double high)
{
  const int count = random.among(4, 8);
  const double start = random.between(0, 2 * M_PI);
  std::vector<gp_Pnt2d> corners;
  for (int k = 0; k < count; ++k)
  {
    const double angle = start + 2 * M_PI * (k + random.between(-0.2, 0.2)) / count;
    const double radius = random.between(low, high);
    corners.emplace_back(
      centre.X() + radius * std::cos(angle), centre.Y() + radius * std::sin(angle));
  }
  return corners;
}

/// A loop round a point of the parameter plane, counter-clockwise, of points between two radii.
TopoDS_Wire randomLoop(Random& random, const Handle(Geom_Surface) & surface, const gp_Pnt2d& centre,
  double low, double high)
{
  BRepBuilderAPI_MakeWire wire;
  const int kind = random.among(0, 2);
  if (kind == 0)
  {
    const Handle(Geom2d_Curve) circle =
      new Geom2d_Circle(gp_Ax2d(centre, gp::DX2d()), random.between(low, high));
    wire.Add(edgeOn(surface, circle, 0, 2 * M_PI));
    return wire.Wire();
  }
  const std::vector<gp_Pnt2d> corners = cornersRound(random, centre, low, high);
  if (kind == 1)
  {
    for (std::size_t k = 0; k < corners.size(); ++k)
    {
      const gp_Pnt2d& next = corners[(k + 1) % corners.size()];
      const Handle(Geom2d_Curve) line =
        new Geom2d_Line(corners[k], gp_Dir2d(gp_Vec2d(corners[k], next)));
      wire.Add(edgeOn(surface, line, 0, corners[k].Distance(next)));
    }
    return wire.Wire();
  }
  const auto count = static_cast<int>(corners.size());
  TColgp_Array1OfPnt2d poles(1, count);
  std::copy(corners.begin(), corners.end(), poles.begin());
  TColStd_Array1OfReal knots(1, count + 1);
  std::iota(knots.begin(), knots.end(), 0.0);
  TColStd_Array1OfInteger multiplicities(1, count + 1);
  multiplicities.Init(1);
  constexpr bool isPeriodic = true;
  const Handle(Geom2d_BSplineCurve) curve =
    new Geom2d_BSplineCurve(poles, knots, multiplicities, random.among(2, 3), isPeriodic);
  wire.Add(edgeOn(surface, curve, curve->FirstParameter(), curve->LastParameter()));
  return wire.Wire();
}

TopoDS_Shape randomTrimmed(Random& random)
{
  const Handle(Geom_BSplineSurface) surface = randomSurface(random);
  const gp_Pnt2d middle(0.5, 0.5);
  BRepBuilderAPI_MakeFace face(surface, randomLoop(random, surface, middle, 0.28, 0.4), true);
  const int holes = random.among(0, 3);
  const double start = random.between(0, 2 * M_PI);
  for (int k = 0; k < holes; ++k)
  {
    const double angle = start + 2 * M_PI * k / holes;
    const gp_Pnt2d centre(0.5 + 0.1 * std::cos(angle), 0.5 + 0.1 * std::sin(angle));
    const TopoDS_Wire hole = randomLoop(random, surface, centre, 0.02, 0.06);
    face.Add(TopoDS::Wire(hole.Reversed()));
  }
  return face.Face();
}

TopoDS_Shape randomRevolved(Random& random)
{
  const Knots knots = randomKnots(random);
  const int last = knots.poleCount() - 1;
  const bool pole[2] = { random.chance(0.5), last > 1 && random.chance(0.5) };
  const Handle(Geom_BSplineCurve) profile = curveOf(knots,
    [&](int i)
    {
      const bool onAxis = (i == 0 && pole[0]) || (i == last && pole[1]);
      const double height = (i + random.between(-0.3, 0.3)) / last;
      return Pole{ gp_Pnt(onAxis ? 0 : random.between(0.1, 0.6), 0, height), randomWeight(random) };
    });
  const TopoDS_Edge edge = BRepBuilderAPI_MakeEdge(profile).Edge();
  const gp_Ax1 axis = gp::OZ();
  return random.chance(0.7) ? BRepPrimAPI_MakeRevol(edge, axis).Shape()
                            : BRepPrimAPI_MakeRevol(edge, axis, random.between(0.5, 5.5)).Shape();
}

TopoDS_Compound compound()
{
  TopoDS_Compound result;
  BRep_Builder().MakeCompound(result);
  return result;
}

} // namespace

const char* nameOf(ShapeKind kind)
{
  constexpr const char* names[]{ "Patch", "Trimmed", "Closed", "Revolved", "Curves" };
  return names[static_cast<int>(kind)];
}

TopoDS_Shape nearUnitCube(Random& random, double offset)
{
  const std::array<Knots, 3> knots{ randomKnots(random), randomKnots(random), randomKnots(random) };
  std::array<double, 3> limits{};
  for (int k = 0; k < 3; ++k)
  {
    limits[k] = std::min(offset, 0.4 / (knots[k].poleCount() - 1)); // no folds
  }
  std::map<std::array<int, 3>, Pole> poles; // those of edges are common to two sides
  const auto poleAt = [&](const std::array<int, 3>& place)
  {
    const auto [found, isNew] = poles.try_emplace(place);
    if (isNew)
    {
      std::array<double, 3> x{};
      for (int k = 0; k < 3; ++k)
      {
        x[k] = static_cast<double>(place[k]) / (knots[k].poleCount() - 1) +
               limits[k] * random.between(-1, 1);
      }
      found->second = { gp_Pnt(x[0], x[1], x[2]), randomWeight(random) };
    }
    return found->second;
  };
  TopoDS_Compound sides = compound();
  for (int axis = 0; axis < 3; ++axis)
  {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const int end : { 0, knots[axis].poleCount() - 1 })
    {
      const auto surface = surfaceOf(knots[u], knots[v],
        [&](int i, int j)
        {
          std::array<int, 3> place{};
          place[axis] = end;
          place[u] = i;
          place[v] = j;
          return poleAt(place);
        });
      BRep_Builder().Add(sides, faceOf(surface));
    }
  }
  return sides;
}

TopoDS_Shape nearUnitCircle(Random& random, double offset)
{
  const int count = random.among(5, 8);
  const double start = random.between(0, 2 * M_PI);
  std::vector<double> angles;
  angles.reserve(count + 1);
  for (int k = 0; k < count; ++k)
  {
    angles.push_back(start + 2 * M_PI * (k + random.between(-0.2, 0.2)) / count);
  }
  angles.push_back(angles.front() + 2 * M_PI);
  TopoDS_Compound curves = compound();
  for (int k = 0; k < count; ++k)
  {
    // Control points on the circle's tangents at the middles of their parts.
    const Knots knots = randomKnots(random);
    const int last = knots.poleCount() - 1;
    const auto curve = curveOf(knots,
      [&](int i)
      {
        const double angle =
          i == last ? angles[(k + 1) % count] : angles[k] + (angles[k + 1] - angles[k]) * i / last;
        const double radius = i == 0 || i == last ? 1 : 1 + offset * random.between(-1, 1);
        const double weight = randomWeight(random);
        return Pole{ gp_Pnt(radius * std::cos(angle), radius * std::sin(angle), 0), weight };
      });
    BRep_Builder().Add(curves, BRepBuilderAPI_MakeEdge(curve).Edge());
  }
  return curves;
}

TopoDS_Shape randomShape(Random& random, ShapeKind kind)
{
  switch (kind)
  {
    case ShapeKind::Patch:
      return faceOf(randomSurface(random));
    case ShapeKind::Trimmed:
      return randomTrimmed(random);
    case ShapeKind::Closed:
      return nearUnitCube(random, random.between(0, 0.15));
    case ShapeKind::Revolved:
      return randomRevolved(random);
    case ShapeKind::Curves:
      return nearUnitCircle(random, random.between(0, 0.3));
  }
  throw std::invalid_argument("no such kind");
}

cadrefine::Point3 Motion::operator()(const cadrefine::Point3& point) const
{
  using namespace cadrefine;
  const Point3 turned{ dot(rows[0], point), dot(rows[1], point), dot(rows[2], point) };
  return scale * turned + shift;
}

Motion randomMotion(Random& random, double lowest, double highest, double sizes, bool inThePlane)
{
  using namespace cadrefine;
  const auto anyVector = [&] {
    return Vector3{ random.between(-1, 1), random.between(-1, 1), random.between(-1, 1) };
  };
  Motion motion;
  const Vector3 up = inThePlane ? Vector3{ 0, 0, 1 } : normalized(anyVector());
  const Vector3 side = normalized(cross(up, anyVector()));
  motion.rows = { side, cross(up, side), up };
  motion.scale = std::pow(10.0, random.between(lowest, highest));
  motion.shift = (sizes * motion.scale) * anyVector();
  motion.shift[2] = inThePlane ? 0 : motion.shift[2];
  return motion;
}

TopoDS_Shape moved(const TopoDS_Shape& shape, const Motion& motion)
{
  gp_Trsf turn;
  const auto& r = motion.rows;
  turn.SetValues(
    r[0][0], r[0][1], r[0][2], 0, r[1][0], r[1][1], r[1][2], 0, r[2][0], r[2][1], r[2][2], 0);
  gp_Trsf size;
  size.SetScaleFactor(motion.scale);
  gp_Trsf shift;
  shift.SetTranslationPart({ motion.shift[0], motion.shift[1], motion.shift[2] });
  constexpr bool copyGeometry = true;
  return BRepBuilderAPI_Transform(shape, shift * size * turn, copyGeometry).Shape();
}

} // namespace propertytest
