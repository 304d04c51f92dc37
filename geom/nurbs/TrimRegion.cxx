#include <cadrefine/nurbs/TrimRegion.h>

#include <cadrefine/nurbs/BernsteinBasis.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace cadrefine
{
namespace
{

Point2 toPoint(const ControlPoint2& p)
{
  return { p[0] / p[2], p[1] / p[2] };
}

bool isMonotone(const std::vector<ControlPoint2>& points, int coordinate)
{
  bool rises = false;
  bool falls = false;
  for (std::size_t i = 1; i < points.size(); ++i)
  {
    const double step = toPoint(points[i])[coordinate] - toPoint(points[i - 1])[coordinate];
    rises = rises || step > 0;
    falls = falls || step < 0;
  }
  return !(rises && falls);
}

ParameterRectangle boundsOf(const std::vector<ControlPoint2>& points)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  ParameterRectangle box = { infinity, -infinity, infinity, -infinity };
  for (const ControlPoint2& point : points)
  {
    const Point2 p = toPoint(point);
    box.s0 = std::min(box.s0, p[0]);
    box.s1 = std::max(box.s1, p[0]);
    box.t0 = std::min(box.t0, p[1]);
    box.t1 = std::max(box.t1, p[1]);
  }
  return box;
}

/// Number of cells of the grid, each way.
constexpr int cellsAlong = 32;

/// Column or row of `x` in the grid over [low, high]; the same for whatever lies beyond as at the
/// border.
int cellIn(double x, double low, double high)
{
  const double share = high > low ? (x - low) / (high - low) : 0.0;
  return std::min(static_cast<int>(std::clamp(share, 0.0, 1.0) * cellsAlong), cellsAlong - 1);
}

/// Splits at the middle (de Casteljau): the first half is returned, `points` becomes the second.
std::vector<ControlPoint2> splitOffFirstHalf(std::vector<ControlPoint2>& points)
{
  const std::size_t degree = points.size() - 1;
  std::vector<ControlPoint2> first(points.size());
  for (std::size_t r = 0; r <= degree; ++r)
  {
    first[r] = points[0];
    for (std::size_t i = 0; i + r < degree; ++i)
    {
      for (int k = 0; k < 3; ++k)
      {
        points[i][k] = 0.5 * (points[i][k] + points[i + 1][k]);
      }
    }
  }
  return first;
}

ParameterRectangle extentOf(const std::vector<TrimLoop>& loops)
{
  std::vector<ControlPoint2> all;
  for (const TrimLoop& loop : loops)
  {
    for (const BezierCurve2& curve : loop)
    {
      all.insert(all.end(), curve.points.begin(), curve.points.end());
    }
  }
  return boundsOf(all);
}

bool overlaps(const ParameterRectangle& a, const ParameterRectangle& b, double bandU, double bandV)
{
  return a.s0 <= b.s1 + bandU && b.s0 <= a.s1 + bandU && a.t0 <= b.t1 + bandV &&
         b.t0 <= a.t1 + bandV;
}

} // namespace

TrimRegion::TrimRegion(const std::vector<TrimLoop>& loops)
  : extent_(extentOf(loops)), unbounded_(loops.empty())
{
  constexpr double relativeBand = 1e-9;
  bandU_ = relativeBand * extent_.width();
  bandV_ = relativeBand * extent_.height();
  for (const TrimLoop& loop : loops)
  {
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      const BezierCurve2& next = loop[(i + 1) % loop.size()];
      addCurve(loop[i]);
      addLine(toPoint(loop[i].points.back()), toPoint(next.points.front()));
    }
  }
  fillBins();
  if (!unbounded_)
  {
    fillCells();
  }
}

void TrimRegion::addLine(const Point2& from, const Point2& to)
{
  if (from != to)
  {
    addPiece({ { from[0], from[1], 1.0 }, { to[0], to[1], 1.0 } }, 0.0, 0);
  }
}

void TrimRegion::addCurve(const BezierCurve2& curve)
{
  // Pieces larger than this both ways are split on, so that few boxes reach into a rectangle.
  constexpr double largestShare = 1.0 / 32.0;
  addPiece(curve.points, largestShare, 0);
}

void TrimRegion::addPiece(std::vector<ControlPoint2> points, double largestShare, int depth)
{
  constexpr int deepest = 40;
  const ParameterRectangle box = boundsOf(points);
  const bool tiny = box.width() <= 1e-3 * bandU_ && box.height() <= 1e-3 * bandV_;
  const bool large = largestShare > 0 && box.width() > largestShare * extent_.width() &&
                     box.height() > largestShare * extent_.height();
  const bool monotone = isMonotone(points, 0) && isMonotone(points, 1);
  if (depth < deepest && !tiny && (large || !monotone))
  {
    const std::vector<ControlPoint2> first = splitOffFirstHalf(points);
    addPiece(first, largestShare, depth + 1);
    addPiece(std::move(points), largestShare, depth + 1);
    return;
  }
  Piece piece;
  piece.box = box;
  piece.first = toPoint(points.front());
  piece.last = toPoint(points.back());
  piece.offset = static_cast<int>(points_.size());
  piece.degree = static_cast<int>(points.size()) - 1;
  if (!monotone)
  {
    points = { points.front(), points.back() };
    piece.degree = 1;
  }
  fitStrip(piece, points);
  points_.insert(points_.end(), points.begin(), points.end());
  pieces_.push_back(piece);
}

void TrimRegion::fitStrip(Piece& piece, const std::vector<ControlPoint2>& points) const
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double height = piece.last[1] - piece.first[1];
  if (!(std::abs(height) > bandV_))
  {
    piece.strip = { -infinity, infinity };
    return;
  }
  piece.slope = (piece.last[0] - piece.first[0]) / height;
  piece.strip = Interval::empty();
  for (const ControlPoint2& point : points)
  {
    const Point2 p = toPoint(point);
    piece.strip.include(p[0] - piece.first[0] - piece.slope * (p[1] - piece.first[1]));
  }
  const double band = 2.0 * (bandU_ + std::abs(piece.slope) * bandV_);
  piece.strip.low -= band;
  piece.strip.high += band;
}

int TrimRegion::sideOf(const Piece& piece, double u, double v) const
{
  const double beside = u - piece.first[0] - piece.slope * (v - piece.first[1]);
  if (beside < piece.strip.low || !overlaps(piece.box, { u, u, v, v }, bandU_, bandV_))
  {
    return -1;
  }
  if (beside > piece.strip.high)
  {
    return 1;
  }
  const double onU = std::clamp(u, piece.box.s0, piece.box.s1);
  const double onV = std::clamp(v, piece.box.t0, piece.box.t1);
  const int ofCurve = compareOther(piece, 1, onV, { u - bandU_, u + bandU_ });
  const bool isNear = ofCurve == 0 || compareOther(piece, 0, onU, { v - bandV_, v + bandV_ }) == 0;
  return isNear ? 0 : -ofCurve;
}

int TrimRegion::binOf(double v) const
{
  const int bins = static_cast<int>(binStart_.size()) - 1;
  const double height = extent_.height();
  const double share = height > 0 ? (v - extent_.t0) / height : 0.0;
  return std::clamp(static_cast<int>(std::clamp(share, 0.0, 1.0) * bins), 0, bins - 1);
}

void TrimRegion::fillBins()
{
  const int bins = std::clamp(2 * static_cast<int>(pieces_.size()), 1, 1024);
  binStart_.assign(bins + 1, 0);
  std::vector<std::vector<int>> lists(bins);
  for (std::size_t i = 0; i < pieces_.size(); ++i)
  {
    const int last = binOf(pieces_[i].box.t1 + bandV_);
    for (int bin = binOf(pieces_[i].box.t0 - bandV_); bin <= last; ++bin)
    {
      lists[bin].push_back(static_cast<int>(i));
    }
  }
  for (int bin = 0; bin < bins; ++bin)
  {
    binItems_.insert(binItems_.end(), lists[bin].begin(), lists[bin].end());
    binStart_[bin + 1] = static_cast<int>(binItems_.size());
  }
}

int TrimRegion::cellOf(double u, double v) const
{
  return cellIn(u, extent_.s0, extent_.s1) + cellsAlong * cellIn(v, extent_.t0, extent_.t1);
}

/// Fills the grid. Cells that the box of a piece, with the band round it, touches are cut. The
/// others are like their left neighbour, or else like their middle.
void TrimRegion::fillCells()
{
  cells_.assign(cellsAlong * cellsAlong, TrimCover::out);
  for (const Piece& piece : pieces_)
  {
    const ParameterRectangle& box = piece.box;
    const int lastRow = cellIn(box.t1 + bandV_, extent_.t0, extent_.t1);
    const int lastColumn = cellIn(box.s1 + bandU_, extent_.s0, extent_.s1);
    for (int row = cellIn(box.t0 - bandV_, extent_.t0, extent_.t1); row <= lastRow; ++row)
    {
      for (int i = cellIn(box.s0 - bandU_, extent_.s0, extent_.s1); i <= lastColumn; ++i)
      {
        cells_[cellsAlong * row + i] = TrimCover::cut;
      }
    }
  }
  for (int i = 0; i < cellsAlong * cellsAlong; ++i)
  {
    if (cells_[i] == TrimCover::cut)
    {
      continue;
    }
    const int column = i % cellsAlong;
    const int row = i / cellsAlong;
    if (column > 0 && cells_[i - 1] != TrimCover::cut)
    {
      cells_[i] = cells_[i - 1];
      continue;
    }
    const double u = extent_.s0 + (column + 0.5) / cellsAlong * extent_.width();
    const double v = extent_.t0 + (row + 0.5) / cellsAlong * extent_.height();
    cells_[i] = containsByRay(u, v) ? TrimCover::in : TrimCover::out;
  }
}

Point2 TrimRegion::pointOn(const Piece& piece, double x) const
{
  BasisValues basis;
  bernsteinValues(piece.degree, x, basis);
  ControlPoint2 sum{};
  for (int i = 0; i <= piece.degree; ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      sum[k] += basis[i] * points_[piece.offset + i][k];
    }
  }
  return toPoint(sum);
}

/// Whether the coordinate (0: u, 1: v) other than `known`, where the known one takes `value`, is
/// below, in or above the interval (-1, 0, 1); `value` lies between the piece's ends. By regula
/// falsi (Illinois), which always ends; the curve is monotone, so that its places on both sides of
/// the one that is sought are bounds.
int TrimRegion::compareOther(
  const Piece& piece, int known, double value, const Interval& with) const
{
  const int other = 1 - known;
  const auto compare = [&](double a, double b) {
    return std::max(a, b) < with.low ? -1 : std::min(a, b) > with.high ? 1 : 0;
  };
  double low = 0;
  double high = 1;
  double atLow = piece.first[known] - value;
  double atHigh = piece.last[known] - value;
  double otherAtLow = piece.first[other];
  double otherAtHigh = piece.last[other];
  if (atLow == 0 || atHigh == 0 || atLow == atHigh)
  {
    const double end = atLow == 0 ? otherAtLow : otherAtHigh;
    return compare(end, end);
  }
  Point2 p = piece.first;
  const double small = 1e-15 * (std::abs(atLow) + std::abs(atHigh));
  for (int i = 0; i < 60; ++i)
  {
    const double x = std::clamp((low * atHigh - high * atLow) / (atHigh - atLow), low, high);
    p = pointOn(piece, x);
    const double here = p[known] - value;
    if (std::abs(here) <= small)
    {
      break;
    }
    if ((here > 0) == (atHigh > 0))
    {
      high = x;
      atHigh = here;
      atLow *= 0.5;
      otherAtHigh = p[other];
    }
    else
    {
      low = x;
      atLow = here;
      atHigh *= 0.5;
      otherAtLow = p[other];
    }
    if (const int side = compare(otherAtLow, otherAtHigh); side != 0)
    {
      return side;
    }
  }
  return compare(p[other], p[other]);
}

bool TrimRegion::contains(double u, double v) const
{
  if (unbounded_)
  {
    return true;
  }
  if (!overlaps(extent_, { u, u, v, v }, bandU_, bandV_))
  {
    return false;
  }
  const TrimCover cover = cells_[cellOf(u, v)];
  return cover == TrimCover::cut ? containsByRay(u, v) : cover == TrimCover::in;
}

bool TrimRegion::containsByRay(double u, double v) const
{
  const int bin = binOf(v);
  bool inside = false;
  for (int i = binStart_[bin]; i < binStart_[bin + 1]; ++i)
  {
    const Piece& piece = pieces_[binItems_[i]];
    if (u > piece.box.s1 + bandU_)
    {
      continue;
    }
    const int side = sideOf(piece, u, v);
    if (side == 0)
    {
      return true;
    }
    const bool spans = (piece.first[1] <= v) != (piece.last[1] <= v);
    inside = inside != (spans && side < 0);
  }
  return inside;
}

TrimCover TrimRegion::classify(const ParameterRectangle& r) const
{
  if (unbounded_)
  {
    return TrimCover::in;
  }
  if (!overlaps(extent_, r, bandU_, bandV_))
  {
    return TrimCover::out;
  }
  const int last = binOf(r.t1 + bandV_);
  for (int bin = binOf(r.t0 - bandV_); bin <= last; ++bin)
  {
    for (int i = binStart_[bin]; i < binStart_[bin + 1]; ++i)
    {
      if (overlaps(pieces_[binItems_[i]].box, r, bandU_, bandV_))
      {
        return TrimCover::cut;
      }
    }
  }
  return contains(r.middleS(), r.middleT()) ? TrimCover::in : TrimCover::out;
}

} // namespace cadrefine
