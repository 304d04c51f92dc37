#include <cadrefine/nurbs/EntityMeasure.h>

#include <cadrefine/nurbs/TrimRegion.h>

#include <algorithm>
#include <cmath>

namespace cadrefine
{
namespace
{

struct GridSum
{
  double area = 0;
  int inside = 0; ///< Number of points inside.
};

/// Sums over the part of a patch that is in `extent`, with `steps` squared points.
GridSum sumOver(
  const BezierPatch& patch, const ParameterRectangle& extent, const TrimRegion& trims, int steps)
{
  const double u0 = std::max(patch.u0, extent.s0);
  const double v0 = std::max(patch.v0, extent.t0);
  const double stepU = (std::min(patch.u1, extent.s1) - u0) / steps;
  const double stepV = (std::min(patch.v1, extent.t1) - v0) / steps;
  GridSum sum;
  for (int i = 0; i < steps && stepU > 0 && stepV > 0; ++i)
  {
    for (int j = 0; j < steps; ++j)
    {
      const double u = u0 + (i + 0.5) * stepU;
      const double v = v0 + (j + 0.5) * stepV;
      if (trims.contains(u, v))
      {
        const PatchDerivatives d = evaluateDerivatives(patch, u, v);
        sum.area += norm(cross(d.u, d.v)) * stepU * stepV;
        ++sum.inside;
      }
    }
  }
  return sum;
}

ParameterRectangle extentOf(const NurbsFace& face, const TrimRegion& trims)
{
  const BezierPatch& first = face.patches.front();
  const BezierPatch& last = face.patches.back();
  return face.loops.empty() ? ParameterRectangle{ first.u0, last.u1, first.v0, last.v1 }
                            : trims.extent();
}

} // namespace

double areaOf(const NurbsFace& face, double points)
{
  constexpr int enough = 96; // inside
  constexpr int mostSteps = 64;
  const TrimRegion trims(face.loops);
  const ParameterRectangle extent = extentOf(face, trims);
  const double patches = static_cast<double>(face.patches.size());
  int steps = std::max(4, static_cast<int>(std::ceil(std::sqrt(points / patches))));
  GridSum total;
  do
  {
    total = {};
    for (const BezierPatch& patch : face.patches)
    {
      const GridSum sum = sumOver(patch, extent, trims, steps);
      total.area += sum.area;
      total.inside += sum.inside;
    }
    steps *= 2;
  } while (total.inside < enough && steps <= mostSteps);
  return total.area;
}

double lengthOf(const NurbsEdge& edge)
{
  constexpr int chords = 16;
  double length = 0;
  for (const BezierCurve& segment : edge.segments)
  {
    const double step = (segment.t1 - segment.t0) / chords;
    for (int i = 0; i < chords; ++i)
    {
      const double t = segment.t0 + i * step;
      length += distance(evaluate(segment, t), evaluate(segment, t + step));
    }
  }
  return length;
}

} // namespace cadrefine
