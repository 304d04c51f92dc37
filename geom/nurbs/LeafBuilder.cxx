#include <cadrefine/nurbs/LeafBuilder.h>

#include <cadrefine/nurbs/BezierSubdivision.h>

#include <algorithm>
#include <deque>

namespace cadrefine
{
namespace
{

struct Part
{
  ParameterRectangle rectangle;
  int depth = 0;
};

/// A part of a patch in the face's own parameters.
ParameterRectangle faceRectangle(const SearchPatch& patch, const ParameterRectangle& part)
{
  const auto low = patch.parametersAt(part.s0, part.t0);
  const auto high = patch.parametersAt(part.s1, part.t1);
  return { low[0], high[0], low[1], high[1] };
}

BoundingBox hullBox(const std::vector<ControlPoint>& points)
{
  BoundingBox box;
  for (const ControlPoint& p : points)
  {
    box.include(toPoint(p));
  }
  return box;
}

/// Whether the distance is known to be convex over the leaf for points close to it: on it, and off
/// it by half its shorter side.
bool isConvexNearby(const PatchView& leaf, const ConvexityBounds& bounds)
{
  const double shorter =
    leaf.isCurve() ? bounds.lengthS() : std::min(bounds.lengthS(), bounds.lengthT());
  for (const double s : { 0.0, 0.5, 1.0 })
  {
    for (const double t : { 0.0, 0.5, 1.0 })
    {
      const PatchDerivatives d = evaluateLocalDerivatives(leaf, s, t);
      const Vector3 normal = normalized(leaf.isCurve() ? d.uu : cross(d.u, d.v));
      for (const double side : { -0.5, 0.0, 0.5 })
      {
        if (!bounds.ask(d.value + side * shorter * normal).convex)
        {
          return false;
        }
      }
    }
  }
  return true;
}

bool isFinished(const PatchView& view, const SearchLeaf& leaf, int depth, const LeafLimits& limits)
{
  constexpr int deepest = 20;
  const double radius = leaf.bounds.radius();
  if (depth >= deepest || radius <= limits.smallestRadius)
  {
    return true;
  }
  return radius <= limits.largestRadius && isConvexNearby(view, leaf.bounds);
}

/// Whether to cut across s: the direction along which the patch varies more, or else the longer.
bool cutAcrossS(const SearchLeaf& leaf, bool isCurve)
{
  const ConvexityBounds& b = leaf.bounds;
  constexpr double nearlyFlat = 0.5; // radians, or relative stretch
  if (isCurve)
  {
    return true;
  }
  if (b.variationS() <= nearlyFlat && b.variationT() <= nearlyFlat)
  {
    return b.lengthS() >= b.lengthT();
  }
  return b.variationS() > b.variationT();
}

} // namespace

std::vector<BuiltLeaf> buildLeaves(
  const SearchPatch& patch, const TrimRegion* trim, const LeafLimits& limits)
{
  std::vector<BuiltLeaf> built;
  std::deque<Part> waiting = { Part{} };
  while (!waiting.empty())
  {
    const Part part = waiting.front();
    waiting.pop_front();
    const TrimCover cover =
      trim ? trim->classify(faceRectangle(patch, part.rectangle)) : TrimCover::in;
    if (cover == TrimCover::out)
    {
      continue;
    }
    const std::vector<ControlPoint> points = restrictPatch(patch.view, part.rectangle);
    BuiltLeaf candidate;
    const ParameterRectangle& r = part.rectangle;
    candidate.leaf.sides = { static_cast<float>(r.s0), static_cast<float>(r.s1),
      static_cast<float>(r.t0), static_cast<float>(r.t1) };
    candidate.leaf.cut = cover == TrimCover::cut;
    const PatchView view = { points.data(), patch.view.degreeU, patch.view.degreeV };
    candidate.leaf.bounds = ConvexityBounds(view);
    const bool full = static_cast<int>(built.size() + waiting.size()) >= limits.mostLeaves;
    if (full || isFinished(view, candidate.leaf, part.depth, limits))
    {
      candidate.box = hullBox(points);
      built.push_back(candidate);
      continue;
    }
    const bool acrossS = cutAcrossS(candidate.leaf, patch.view.isCurve());
    waiting.push_back({ part.rectangle.half(acrossS, false), part.depth + 1 });
    waiting.push_back({ part.rectangle.half(acrossS, true), part.depth + 1 });
  }
  return built;
}

} // namespace cadrefine
