#include "ModelCheck.h"

#include "BernsteinBasis.h"
#include "Error.h"
#include "PatchView.h"

#include <cmath>
#include <string>

namespace cadrefine
{
namespace
{

[[noreturn]] void refuse(EntityId id, const std::string& what)
{
  const char* const kinds[] = { "vertex ", "edge ", "face " };
  throw Error(
    "CAD model: " + std::string(kinds[id.dimension]) + std::to_string(id.index) + " " + what);
}

bool isInRange(double coordinate)
{
  return std::abs(coordinate) <= largestCoordinate; // false for NaN
}

template<typename Coordinates>
void checkCoordinates(const Coordinates& coordinates, const char* what, EntityId id)
{
  for (const double coordinate : coordinates)
  {
    if (!isInRange(coordinate))
    {
      refuse(id, "has a " + std::string(what) + " that is not finite or beyond 1e50");
    }
  }
}

/// Control points of a curve or surface in space or in the parameter plane; the weight is last.
template<typename Points>
void checkPoints(const Points& points, EntityId id)
{
  for (const auto& point : points)
  {
    checkCoordinates(point, "control point", id);
    if (!(point.back() >= 1 / largestCoordinate))
    {
      refuse(id, "has a control point of a weight that is not positive");
    }
    for (const double coordinate : point)
    {
      checkCoordinates(std::array<double, 1>{ coordinate / point.back() }, "control point", id);
    }
  }
}

void checkPatch(const PatchView& view, const std::vector<ControlPoint>& points, EntityId id)
{
  if (view.degreeU < 0 || view.degreeV < 0 || view.degreeU > maximumDegree ||
      view.degreeV > maximumDegree)
  {
    refuse(id, "has a degree outside 0 to " + std::to_string(maximumDegree));
  }
  if (points.size() != static_cast<std::size_t>(view.count()))
  {
    refuse(id, "has control points that are too few or too many");
  }
  checkPoints(points, id);
}

void checkFace(const NurbsFace& face, EntityId id)
{
  for (const BezierPatch& patch : face.patches)
  {
    checkPatch(viewOf(patch), patch.points, id);
    checkCoordinates(std::array{ patch.u0, patch.u1, patch.v0, patch.v1 }, "parameter", id);
  }
  for (const TrimLoop& loop : face.loops)
  {
    for (const BezierCurve2& curve : loop)
    {
      checkPoints(curve.points, id);
    }
  }
}

void checkEdge(const NurbsEdge& edge, EntityId id)
{
  for (const BezierCurve& segment : edge.segments)
  {
    checkPatch(viewOf(segment), segment.points, id);
    checkCoordinates(std::array{ segment.t0, segment.t1 }, "parameter", id);
  }
}

} // namespace

void checkModel(const NurbsModel& model)
{
  for (std::int32_t i = 0; i < model.count(0); ++i)
  {
    checkCoordinates(model.vertices[i].point, "point", { 0, i });
  }
  for (std::int32_t i = 0; i < model.count(1); ++i)
  {
    checkEdge(model.edges[i], { 1, i });
  }
  for (std::int32_t i = 0; i < model.count(2); ++i)
  {
    checkFace(model.faces[i], { 2, i });
  }
}

} // namespace cadrefine
