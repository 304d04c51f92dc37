#include <cadrefine/nurbs/TrimMeasure.h>

#include <cadrefine/nurbs/DistanceMinimizer.h>
#include <cadrefine/nurbs/PatchView.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace cadrefine
{
namespace
{

/// An edge's curve with points along it, to start from.
class EdgeCurve
{
public:
  explicit EdgeCurve(const NurbsEdge& edge) : edge_(&edge)
  {
    for (std::size_t i = 0; i < edge.segments.size(); ++i)
    {
      for (int k = 0; k <= starts; ++k)
      {
        const double s = static_cast<double>(k) / starts;
        samples_.push_back({ i, s, evaluateLocal(viewOf(edge.segments[i]), s, 0) });
        const bool follows = samples_.size() > 1 && k > 0;
        const double step =
          follows ? squaredNorm(samples_.back().point - samples_[samples_.size() - 2].point) : 0;
        spacing_ = std::max(spacing_, step);
      }
    }
  }

  /// Distance of `p` from the curve, by Newton's method from the nearest sample; never too small.
  double distanceTo(const Point3& p) const
  {
    const auto nearest = std::min_element(samples_.begin(), samples_.end(),
      [&](const Sample& a, const Sample& b)
      { return squaredNorm(a.point - p) < squaredNorm(b.point - p); });
    if (nearest == samples_.end())
    {
      return std::numeric_limits<double>::infinity();
    }
    double least = squaredNorm(nearest->point - p);
    for (const Sample& sample : samples_)
    {
      // Also on the other side of where two segments join.
      if (&sample == &*nearest || squaredNorm(sample.point - nearest->point) <= 1e-2 * spacing_)
      {
        const PatchView view = viewOf(edge_->segments[sample.segment]);
        const double scale = std::sqrt(spacing_) + std::sqrt(least);
        least = std::min(
          least, minimizeDistance(view, p, { 0, 1, 0, 0 }, sample.s, 0, scale).squaredDistance);
      }
    }
    return std::sqrt(least);
  }

private:
  static constexpr int starts = 8; ///< Starting points in each segment.

  struct Sample
  {
    std::size_t segment;
    double s;
    Point3 point;
  };

  const NurbsEdge* edge_;
  double spacing_ = 0; ///< Largest squared distance between two samples that follow each other.
  std::vector<Sample> samples_;
};

/// Nine points of the curve in space.
std::vector<Point3> pointsAlong(const NurbsFace& face, const BezierCurve2& curve)
{
  constexpr int steps = 8;
  std::vector<Point3> points;
  for (int k = 0; k <= steps; ++k)
  {
    points.push_back(pointOnFace(face, curve, static_cast<double>(k) / steps));
  }
  return points;
}

double farthestFrom(const EdgeCurve& edge, const std::vector<Point3>& points)
{
  double farthest = 0;
  for (const Point3& p : points)
  {
    farthest = std::max(farthest, edge.distanceTo(p));
  }
  return farthest;
}

double farthestFrom(const NurbsVertex& vertex, const std::vector<Point3>& points)
{
  double farthest = 0;
  for (const Point3& p : points)
  {
    farthest = std::max(farthest, distance(vertex.point, p));
  }
  return farthest;
}

/// The support of a curve that does not know its edge: the edge of the face that it follows best,
/// or none where it stays nearer to an end of one.
TrimSupport findSupport(
  const NurbsModel& model, const NurbsFace& face, const std::vector<Point3>& points)
{
  TrimSupport best;
  for (const std::int32_t edge : face.edges)
  {
    for (const std::int32_t end : { model.edges[edge].firstVertex, model.edges[edge].lastVertex })
    {
      best.deviation = end < 0
                         ? best.deviation
                         : std::min(best.deviation, farthestFrom(model.vertices[end], points));
    }
  }
  for (const std::int32_t edge : face.edges)
  {
    const double deviation = farthestFrom(EdgeCurve(model.edges[edge]), points);
    best = deviation < best.deviation ? TrimSupport{ edge, deviation } : best;
  }
  return best;
}

} // namespace

Point3 pointOnFace(const NurbsFace& face, const BezierCurve2& curve, double t)
{
  Point2 uv = evaluate(curve, t);
  uv[0] = std::clamp(uv[0], face.patches.front().u0, face.patches.back().u1);
  uv[1] = std::clamp(uv[1], face.patches.front().v0, face.patches.back().v1);
  return evaluate(patchAt(face, uv[0], uv[1]), uv[0], uv[1]);
}

TrimSupport trimSupport(const NurbsModel& model, const NurbsFace& face, const BezierCurve2& curve)
{
  const std::vector<Point3> points = pointsAlong(face, curve);
  return curve.edge < 0
           ? findSupport(model, face, points)
           : TrimSupport{ curve.edge, farthestFrom(EdgeCurve(model.edges[curve.edge]), points) };
}

double farthestFrom(const NurbsEdge& other, const NurbsEdge& edge)
{
  constexpr int steps = 8;
  std::vector<Point3> points;
  for (const BezierCurve& segment : edge.segments)
  {
    for (int k = 0; k <= steps; ++k)
    {
      points.push_back(evaluateLocal(viewOf(segment), static_cast<double>(k) / steps, 0));
    }
  }
  return farthestFrom(EdgeCurve(other), points);
}

void measureTrims(const NurbsModel& model, NurbsFace& face)
{
  for (TrimLoop& loop : face.loops)
  {
    std::optional<EdgeCurve> edge; // Of the curve before, whose edge this one mostly has, too.
    std::int32_t number = -1;
    for (BezierCurve2& curve : loop)
    {
      if (curve.edge < 0)
      {
        const TrimSupport support = trimSupport(model, face, curve);
        curve.edge = support.edge;
        curve.deviation = support.deviation;
        continue;
      }
      if (curve.edge != number)
      {
        number = curve.edge;
        edge.emplace(model.edges[number]);
      }
      curve.deviation = farthestFrom(*edge, pointsAlong(face, curve));
    }
  }
}

double largestTrimDeviation(const NurbsModel& model)
{
  double largest = 0;
  for (const NurbsFace& face : model.faces)
  {
    for (const TrimLoop& loop : face.loops)
    {
      for (const BezierCurve2& curve : loop)
      {
        largest = curve.edge >= 0 ? std::max(largest, curve.deviation) : largest;
      }
    }
  }
  return largest;
}

} // namespace cadrefine
