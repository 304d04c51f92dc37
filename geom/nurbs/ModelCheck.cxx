#include <cadrefine/nurbs/ModelCheck.h>

#include <cadrefine/base/Error.h>
#include <cadrefine/nurbs/BernsteinBasis.h>
#include <cadrefine/nurbs/PatchView.h>

#include <cmath>
#include <string>

namespace cadrefine
{
namespace
{

bool isInRange(double coordinate)
{
  return std::abs(coordinate) <= largestCoordinate; // false for NaN
}

template<typename Coordinates>
void checkCoordinates(const Coordinates& coordinates, const char* what)
{
  for (const double coordinate : coordinates)
  {
    if (!isInRange(coordinate))
    {
      throw Error("has a " + std::string(what) + " that is not finite or beyond 1e50");
    }
  }
}

/// Checks control points of a curve or surface in space or in the parameter plane; the weight is
/// last.
template<typename Points>
void checkPoints(const Points& points)
{
  for (const auto& point : points)
  {
    checkCoordinates(point, "control point");
    if (!(point.back() >= 1 / largestCoordinate))
    {
      throw Error("has a control point whose weight is not positive");
    }
    for (const double coordinate : point)
    {
      checkCoordinates(std::array<double, 1>{ coordinate / point.back() }, "control point");
    }
  }
}

void checkPatch(const PatchView& view, const std::vector<ControlPoint>& points)
{
  if (view.degreeU < 0 || view.degreeV < 0 || view.degreeU > maximumDegree ||
      view.degreeV > maximumDegree)
  {
    throw Error("has a degree outside 0 to " + std::to_string(maximumDegree));
  }
  if (points.size() != static_cast<std::size_t>(view.count()))
  {
    throw Error("has too few or too many control points");
  }
  checkPoints(points);
}

void checkFace(const NurbsFace& face)
{
  for (const BezierPatch& patch : face.patches)
  {
    checkPatch(viewOf(patch), patch.points);
    checkCoordinates(std::array{ patch.u0, patch.u1, patch.v0, patch.v1 }, "parameter");
  }
  for (const TrimLoop& loop : face.loops)
  {
    for (const BezierCurve2& curve : loop)
    {
      checkPoints(curve.points);
    }
  }
}

void checkEdge(const NurbsEdge& edge)
{
  for (const BezierCurve& segment : edge.segments)
  {
    checkPatch(viewOf(segment), segment.points);
    checkCoordinates(std::array{ segment.t0, segment.t1 }, "parameter");
  }
}

/// The text of what `check` throws; empty: it throws nothing.
template<typename Check>
std::string faultFoundBy(const Check& check)
{
  try
  {
    check();
    return {};
  }
  catch (const Error& fault)
  {
    return fault.what();
  }
}

void refuse(const char* kind, int index, const std::string& fault)
{
  if (!fault.empty())
  {
    throw Error("CAD model: " + std::string(kind) + " " + std::to_string(index) + " " + fault);
  }
}

} // namespace

std::string faultOf(const NurbsFace& face)
{
  return faultFoundBy([&] { checkFace(face); });
}

std::string faultOf(const NurbsEdge& edge)
{
  return faultFoundBy([&] { checkEdge(edge); });
}

void checkModel(const NurbsModel& model)
{
  for (int i = 0; i < model.count(0); ++i)
  {
    refuse("vertex", i, faultFoundBy([&] { checkCoordinates(model.vertices[i].point, "point"); }));
  }
  for (int i = 0; i < model.count(1); ++i)
  {
    refuse("edge", i, faultOf(model.edges[i]));
  }
  for (int i = 0; i < model.count(2); ++i)
  {
    refuse("face", i, faultOf(model.faces[i]));
  }
}

} // namespace cadrefine
