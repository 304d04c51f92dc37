// 1. Split the face's B-spline surface into Bezier patches (one period of a periodic one).
// 2. Take the trim loops, and lay the patches over the parameters they span, repeating them by
//    whole periods; cut the outermost ones where the loops end.
// 3. Forget the loops where they only run round the patches.

#include "NurbsExtraction.h"

#include "BezierConversion.h"
#include "BezierSubdivision.h"
#include "Error.h"
#include "TrimLoops.h"

#include <BRep_Tool.hxx>

#include <algorithm>
#include <cmath>

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
  double localFrom = 0; ///< The same, from 0 to 1 over the source.
  double localTo = 1;
};

/// Spans of the old knots, repeated with `period`, that cover [low, high].
std::vector<Span> coverRange(
  const std::vector<double>& knots, double period, double low, double high)
{
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
      if (high < to - tolerance)
      {
        span.to = high;
        span.localTo = (high - from) / (to - from);
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
  if (u.localFrom > 0 || u.localTo < 1 || v.localFrom > 0 || v.localTo < 1)
  {
    part.points = restrictPatch(viewOf(patch), { u.localFrom, u.localTo, v.localFrom, v.localTo });
  }
  return part;
}

void layPatches(const PatchGrid& grid, const ParameterBox& box, NurbsFace& face)
{
  const auto u = coverRange(knotsAlongU(grid), grid.periodU, box.u0, box.u1);
  const auto v = coverRange(knotsAlongV(grid), grid.periodV, box.v0, box.v1);
  face.patchesU = static_cast<int>(u.size());
  face.patchesV = static_cast<int>(v.size());
  for (const Span& spanU : u)
  {
    for (const Span& spanV : v)
    {
      const BezierPatch& source = grid.patches[spanU.source * grid.patchesV + spanV.source];
      face.patches.push_back(partOf(source, spanU, spanV));
    }
  }
}

ParameterBox boxOf(const std::vector<BezierPatch>& patches)
{
  return { patches.front().u0, patches.back().u1, patches.front().v0, patches.back().v1 };
}

} // namespace

NurbsFace extractFace(const TopoDS_Face& face)
{
  NurbsFace result;
  result.reversed = face.Orientation() == TopAbs_REVERSED;
  result.tolerance = BRep_Tool::Tolerance(face);
  const PatchGrid grid = bezierPatches(BRep_Tool::Surface(face));
  result.loops = extractLoops(face, grid.periodU, grid.periodV);
  layPatches(grid, result.loops.empty() ? boxOf(grid.patches) : hullOf(result.loops), result);
  if (result.patches.empty())
  {
    throw Error("a face's trim curves lie outside of its surface");
  }
  if (followsBorder(result.loops, boxOf(result.patches)))
  {
    result.loops.clear();
  }
  return result;
}

} // namespace cadrefine
