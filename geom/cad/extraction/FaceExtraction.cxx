// 1. Take the trim loops; their extent is the window of the surface that is of interest.
// 2. Convert the surface to Bezier patches; lay those of a spline over the window, repeating them
//    by whole periods, and cut or continue the outermost ones where it ends.
// 3. Map the loops to the parameters of the patches, and forget them where they only run round
//    these.

#include <cadrefine/cad/extraction/NurbsExtraction.h>

#include <cadrefine/base/Error.h>
#include <cadrefine/cad/extraction/BezierConversion.h>
#include <cadrefine/cad/extraction/SurfaceConversion.h>
#include <cadrefine/cad/extraction/TrimLoops.h>
#include <cadrefine/nurbs/BezierSubdivision.h>

#include <BRep_Tool.hxx>
#include <TopLoc_Location.hxx>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cadrefine
{
namespace
{

/// One column (or row) of the new grid: which patches of the old one, and what part of them.
struct Span
{
  int source = 0;
  double from = 0; ///< Parameters after the shift by whole periods.
  double to = 0;
  double localFrom = 0; ///< These as local parameters, from 0 to 1 over the source.
  double localTo = 1;
};

/// A range of parameters, and how far beyond the knots patches are to reach in it.
struct Cover
{
  double low = 0;
  double high = 0;
  double reachLow = std::numeric_limits<double>::infinity();
  double reachHigh = -std::numeric_limits<double>::infinity();
};

/// Spans of the old knots, repeated with `period`, that cover a range. Without a period the
/// outermost ones reach beyond their knots, by their own width at most: trim curves stick out of
/// their splines in many files, and Open CASCADE continues the polynomials there.
std::vector<Span> coverRange(const std::vector<double>& knots, double period, const Cover& cover)
{
  const auto& [low, high, reachLow, reachHigh] = cover;
  const double first = knots.front();
  const double last = knots.back();
  const double tolerance = 1e-9 * (last - first);
  const int copies = period > 0 ? static_cast<int>(std::floor((low - first) / period)) : 0;
  const int copiesEnd = period > 0 ? static_cast<int>(std::ceil((high - first) / period)) : 1;
  std::vector<Span> spans;
  for (int copy = copies - (period > 0 ? 1 : 0); copy < copiesEnd + (period > 0 ? 1 : 0); ++copy)
  {
    for (std::size_t k = 0; k + 1 < knots.size(); ++k)
    {
      const double from = knots[k] + copy * period;
      const double to = knots[k + 1] + copy * period;
      if (to <= low + tolerance || from >= high - tolerance)
      {
        continue;
      }
      Span span{ static_cast<int>(k), from, to, 0, 1 };
      if (low > from + tolerance)
      {
        span.from = low;
        span.localFrom = (low - from) / (to - from);
      }
      else if (period == 0 && k == 0 && reachLow < from - tolerance)
      {
        span.from = std::max(reachLow, from - (to - from));
        span.localFrom = (span.from - from) / (to - from);
      }
      if (high < to - tolerance)
      {
        span.to = high;
        span.localTo = (high - from) / (to - from);
      }
      else if (period == 0 && k + 2 == knots.size() && reachHigh > to + tolerance)
      {
        span.to = std::min(reachHigh, to + (to - from));
        span.localTo = (span.to - from) / (to - from);
      }
      spans.push_back(span);
    }
  }
  return spans;
}

std::vector<double> knotsAlongU(const PatchGrid& grid)
{
  std::vector<double> knots{ grid.patches.front().u0 };
  for (int i = 0; i < grid.patchesU; ++i)
  {
    knots.push_back(grid.patches[i * grid.patchesV].u1);
  }
  return knots;
}

std::vector<double> knotsAlongV(const PatchGrid& grid)
{
  std::vector<double> knots{ grid.patches.front().v0 };
  for (int j = 0; j < grid.patchesV; ++j)
  {
    knots.push_back(grid.patches[j].v1);
  }
  return knots;
}

BezierPatch partOf(const BezierPatch& patch, const Span& u, const Span& v)
{
  BezierPatch part = patch;
  part.u0 = u.from;
  part.u1 = u.to;
  part.v0 = v.from;
  part.v1 = v.to;
  if (u.localFrom != 0 || u.localTo != 1 || v.localFrom != 0 || v.localTo != 1)
  {
    part.points = restrictPatch(viewOf(patch), { u.localFrom, u.localTo, v.localFrom, v.localTo });
  }
  return part;
}

void layPatches(const PatchGrid& grid, const Cover& coverU, const Cover& coverV, NurbsFace& face)
{
  const auto u = coverRange(knotsAlongU(grid), grid.periodU, coverU);
  const auto v = coverRange(knotsAlongV(grid), grid.periodV, coverV);
  face.patchesU = static_cast<int>(u.size());
  face.patchesV = static_cast<int>(v.size());
  face.patches.clear();
  for (const Span& spanU : u)
  {
    for (const Span& spanV : v)
    {
      const BezierPatch& source = grid.patches[spanU.source * grid.patchesV + spanV.source];
      face.patches.push_back(partOf(source, spanU, spanV));
    }
  }
}

bool hasPositiveWeights(const std::vector<BezierPatch>& patches)
{
  return std::all_of(patches.begin(), patches.end(),
    [](const BezierPatch& patch)
    {
      return std::all_of(patch.points.begin(), patch.points.end(),
        [](const ControlPoint& point) { return point[3] > 0; });
    });
}

/// Patches over the loops' hull, and where these stick out of a spline, as far beyond it as it can
/// be continued.
void layPatches(const PatchGrid& grid, const ParameterBox& window,
  const std::vector<TrimLoop>& loops, NurbsFace& face)
{
  const ParameterBox reach = extentOf(loops);
  layPatches(grid, { window.u0, window.u1, reach.u0, reach.u1 },
    { window.v0, window.v1, reach.v0, reach.v1 }, face);
  if (!hasPositiveWeights(face.patches))
  {
    layPatches(grid, { window.u0, window.u1 }, { window.v0, window.v1 }, face);
  }
}

ParameterBox boundsOf(const Geom_Surface& surface)
{
  ParameterBox box;
  surface.Bounds(box.u0, box.u1, box.v0, box.v1);
  return box;
}

void transformPatches(const gp_Trsf& trsf, std::vector<BezierPatch>& patches)
{
  for (BezierPatch& patch : patches)
  {
    transform(trsf, patch.points);
  }
}

ParameterBox boxOf(const std::vector<BezierPatch>& patches)
{
  return { patches.front().u0, patches.back().u1, patches.front().v0, patches.back().v1 };
}

} // namespace

NurbsFace extractFace(const TopoDS_Face& face, const ShapeIndex* index)
{
  NurbsFace result;
  result.reversed = face.Orientation() == TopAbs_REVERSED;
  result.tolerance = BRep_Tool::Tolerance(face);
  TopLoc_Location location;
  const Handle(Geom_Surface) surface = untrimmed(BRep_Tool::Surface(face, location));
  const double periodU = surface->IsUPeriodic() ? surface->UPeriod() : 0;
  const double periodV = surface->IsVPeriodic() ? surface->VPeriod() : 0;
  const std::vector<TrimLoop> loops = extractLoops(face, periodU, periodV, index);
  const ParameterBox window = loops.empty() ? boundsOf(*surface) : hullOf(loops);
  if (!(window.u1 > window.u0 && window.v1 > window.v0))
  {
    throw Error("its trim curves enclose no area");
  }
  const ConvertedSurface converted = convertSurface(surface, window);
  layPatches(converted.grid, window, loops, result);
  if (result.patches.empty())
  {
    throw Error("its trim curves lie outside the surface's parameter domain");
  }
  transformPatches(location.Transformation(), result.patches);
  result.fitError = converted.fitError * std::abs(location.Transformation().ScaleFactor());
  result.loops = mapLoops(loops, converted.mapU, converted.mapV);
  if (followsBorder(result.loops, boxOf(result.patches)))
  {
    result.loops.clear();
  }
  return result;
}

} // namespace cadrefine
