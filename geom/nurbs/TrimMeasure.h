// How far trim curves lie off the edges that they stand for, and edges off each other.
#pragma once

#include <cadrefine/nurbs/NurbsModel.h>

#include <limits>

namespace cadrefine
{

/// The curve's point on its face, at a parameter in [0, 1]. Where the curve sticks out of the
/// face's patches, their border.
Point3 pointOnFace(const NurbsFace& face, const BezierCurve2& curve, double t);

/// The edge that a trim curve stands for, and the largest distance found from nine points of it.
struct TrimSupport
{
  std::int32_t edge = -1; ///< -1: none.
  double deviation = std::numeric_limits<double>::infinity();
};

/// Where the curve does not know its edge, the edge of its face that it follows best; or none, and
/// the distance from an end of one, where that is nearer (at a pole). Work: nine evaluations of the
/// face and nine searches of an edge's curve, some ten microseconds.
TrimSupport trimSupport(const NurbsModel& model, const NurbsFace& face, const BezierCurve2& curve);

/// The largest distance from another edge that is found at nine points of each segment of an edge.
double farthestFrom(const NurbsEdge& other, const NurbsEdge& edge);

/// Sets the edge and the deviation of all trim curves of one of the model's faces.
void measureTrims(const NurbsModel& model, NurbsFace& face);

/// The largest deviation of a trim curve from its edge; 0 where there is none.
double largestTrimDeviation(const NurbsModel& model);

} // namespace cadrefine
