// The trimmed region of a face in its parameter plane. Private to geom/nurbs.
#pragma once

#include <cadrefine/nurbs/Interval.h>
#include <cadrefine/nurbs/NurbsModel.h>
#include <cadrefine/nurbs/ParameterRectangle.h>

#include <cstdint>
#include <vector>

namespace cadrefine
{

/// How a rectangle lies to a trimmed region.
enum class TrimCover : std::uint8_t
{
  in,
  out,
  cut
};

/// Answers whether points lie inside the loops of a face, by the parity of the crossings of a ray.
/// The loops are cut into pieces on which u and v are monotone (by their control polygons), and
/// crossings are solved on the curves themselves. Gaps between consecutive curves are closed with
/// straight lines. Points within 1e-9 of the region's extent of a loop count as inside. No loops:
/// everything is inside. A grid of cells that no loop touches answers for most points at once; for
/// the others a test looks at the pieces at the same v. Memory: some pieces for each curve, and a
/// byte a cell, 1 kB.
class TrimRegion
{
public:
  explicit TrimRegion(const std::vector<TrimLoop>& loops);

  bool contains(double u, double v) const;
  /// `cut` also where it cannot be told cheaply.
  TrimCover classify(const ParameterRectangle& rectangle) const;
  /// Holds all control points of the loops.
  const ParameterRectangle& extent() const { return extent_; }

private:
  /// A curve piece monotone in u and in v, and its bounding rectangle (s is u, t is v).
  struct Piece
  {
    ParameterRectangle box;
    Point2 first, last;
    /// The curve lies where u - first u - slope (v - first v) is in `strip`: beside its chord.
    double slope = 0;
    Interval strip;
    int offset = 0; // of its control points
    int degree = 1;
  };

  void addCurve(const BezierCurve2& curve);
  void addPiece(std::vector<ControlPoint2> points, double smallest, int depth);
  void addLine(const Point2& from, const Point2& to);
  void fillBins();
  void fillCells();
  int binOf(double v) const;
  int cellOf(double u, double v) const;
  bool containsByRay(double u, double v) const;
  void fitStrip(Piece& piece, const std::vector<ControlPoint2>& points) const;
  /// Where a point that is not to the right of the piece's box is: on the piece (0), else, if it is
  /// at the same v, to the left or to the right of it (-1, 1).
  int sideOf(const Piece& piece, double u, double v) const;
  Point2 pointOn(const Piece& piece, double x) const;
  int compareOther(const Piece& piece, int known, double value, const Interval& with) const;

  std::vector<Piece> pieces_;
  std::vector<ControlPoint2> points_;
  std::vector<int> binStart_, binItems_;
  std::vector<TrimCover> cells_; ///< Row by row along u.
  ParameterRectangle extent_;
  double bandU_ = 0;
  double bandV_ = 0;
  bool unbounded_ = false;
};

} // namespace cadrefine
