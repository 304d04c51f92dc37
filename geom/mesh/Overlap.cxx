#include <cadrefine/mesh/Overlap.h>

#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace cadrefine
{
namespace
{

template<std::size_t Corners>
using Coordinates = std::array<double, Corners>;

/// The barycentric coordinates of the corners of a simplex in another one.
template<std::size_t Corners>
using Piece = std::array<Coordinates<Corners>, Corners>;

/// Parts of a simplex, at most three of each tetrahedron or two of each triangle a cut.
template<std::size_t Corners>
struct Pieces
{
  static constexpr std::size_t most = Corners == 4 ? 81 : 8;
  std::array<Piece<Corners>, most> list; // not initialised: it is large, and little of it is used
  std::size_t size = 0;

  void add(const Piece<Corners>& piece) { list[size++] = piece; }
};

/// Where the way from `in` to `out` has coordinate `k` 0.
template<std::size_t Corners>
Coordinates<Corners> crossing(
  const Coordinates<Corners>& in, const Coordinates<Corners>& out, std::size_t k)
{
  const double t = in[k] / (in[k] - out[k]);
  Coordinates<Corners> point;
  for (std::size_t i = 0; i < Corners; ++i)
  {
    point[i] = (1 - t) * in[i] + t * out[i];
  }
  point[k] = 0;
  return point;
}

/// The prism between two facets as simplices, each with some corners of the one and the others of
/// the other.
template<std::size_t Corners>
void addPrism(const std::array<Coordinates<Corners>, Corners - 1>& one,
  const std::array<Coordinates<Corners>, Corners - 1>& other, Pieces<Corners>& parts)
{
  for (std::size_t k = 0; k + 1 < Corners; ++k)
  {
    Piece<Corners> part;
    std::copy(one.begin(), one.begin() + k + 1, part.begin());
    std::copy(other.begin() + k, other.end(), part.begin() + k + 1);
    parts.add(part);
  }
}

/// The part of a piece where coordinate `k` is positive, given that it is not so at all corners.
template<std::size_t Corners>
void addCut(const Piece<Corners>& piece, std::size_t k, Pieces<Corners>& parts)
{
  Piece<Corners> sorted = piece; // those inside first
  const auto firstOut = std::stable_partition(sorted.begin(), sorted.end(),
    [&](const Coordinates<Corners>& corner) { return corner[k] > 0; });
  const auto inside = static_cast<std::size_t>(firstOut - sorted.begin());
  const auto cut = [&](std::size_t in, std::size_t out)
  { return crossing<Corners>(sorted[in], sorted[out], k); };
  if (inside == 1)
  {
    Piece<Corners> part{ sorted[0] };
    for (std::size_t i = 1; i < Corners; ++i)
    {
      part[i] = cut(0, i);
    }
    parts.add(part);
  }
  else if (inside + 1 == Corners)
  {
    std::array<Coordinates<Corners>, Corners - 1> one;
    std::array<Coordinates<Corners>, Corners - 1> other;
    for (std::size_t i = 0; i < inside; ++i)
    {
      one[i] = sorted[i];
      other[i] = cut(i, inside);
    }
    addPrism<Corners>(one, other, parts);
  }
  else if constexpr (Corners == 4)
  {
    addPrism<4>({ sorted[0], cut(0, 2), cut(0, 3) }, { sorted[1], cut(1, 2), cut(1, 3) }, parts);
  }
}

/// How large a piece is, as part of the simplex of the coordinates.
double partOf(const Piece<4>& piece)
{
  const auto row = [&](std::size_t i) -> Vector3 {
    return { piece[i][0] - piece[0][0], piece[i][1] - piece[0][1], piece[i][2] - piece[0][2] };
  };
  return std::abs(dot(row(3), cross(row(1), row(2))));
}

double partOf(const Piece<3>& piece)
{
  const auto& [a, b, c] = piece;
  return std::abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
}

/// The part of the unit simplex that lies in `piece`.
template<std::size_t Corners>
double partInside(const Piece<Corners>& piece)
{
  std::array<Pieces<Corners>, 2> pieces;
  pieces[0].add(piece);
  for (std::size_t k = 0; k < Corners; ++k)
  {
    const Pieces<Corners>& from = pieces[k % 2];
    Pieces<Corners>& to = pieces[(k + 1) % 2];
    to.size = 0;
    for (std::size_t i = 0; i < from.size; ++i)
    {
      const auto [low, high] = std::minmax_element(from.list[i].begin(), from.list[i].end(),
        [&](const auto& a, const auto& b) { return a[k] < b[k]; });
      if ((*low)[k] >= 0)
      {
        to.add(from.list[i]);
      }
      else if ((*high)[k] > 0)
      {
        addCut<Corners>(from.list[i], k, to);
      }
    }
  }
  const Pieces<Corners>& last = pieces[Corners % 2];
  double part = 0;
  for (std::size_t i = 0; i < last.size; ++i)
  {
    part += partOf(last.list[i]);
  }
  return part;
}

/// The corners of `cell` in the coordinates of `frame`.
template<std::size_t Corners>
Piece<Corners> within(const SimplexPoints<Corners>& frame, const SimplexPoints<Corners>& cell)
{
  Piece<Corners> piece;
  std::transform(cell.begin(), cell.end(), piece.begin(),
    [&](const Point3& corner) { return barycentric(frame, corner); });
  return piece;
}

/// Whether all corners are on the outer side of one facet of the frame, or not finite.
template<std::size_t Corners>
bool isApart(const Piece<Corners>& piece)
{
  constexpr double rounding = 1e-14;
  for (std::size_t k = 0; k < Corners; ++k)
  {
    if (std::none_of(
          piece.begin(), piece.end(), [&](const auto& corner) { return corner[k] > rounding; }))
    {
      return true;
    }
  }
  return false;
}

/// Of simplices in one space, with these measures.
template<std::size_t Corners>
double overlapOf(const SimplexPoints<Corners>& small, double smallMeasure,
  const SimplexPoints<Corners>& large, double largeMeasure)
{
  if (smallMeasure > largeMeasure)
  {
    return overlapOf<Corners>(large, largeMeasure, small, smallMeasure);
  }
  const double limit = largeMeasure + smallMeasure;
  if (!(smallMeasure > 0) || !std::isfinite(limit))
  {
    return 0;
  }
  const Piece<Corners> piece = within<Corners>(large, small);
  if (isApart<Corners>(piece) || isApart<Corners>(within<Corners>(small, large)))
  {
    return 0;
  }
  return std::min(partInside<Corners>(piece) * largeMeasure, smallMeasure);
}

} // namespace

double measure(const SimplexPoints<4>& cell)
{
  return std::abs(sixfoldVolume(cell[0], cell[1], cell[2], cell[3])) / 6;
}

double measure(const SimplexPoints<3>& cell)
{
  return norm(twofoldAreaVector(cell[0], cell[1], cell[2])) / 2;
}

std::array<double, 4> barycentric(const SimplexPoints<4>& cell, const Point3& point)
{
  const auto& [a, b, c, d] = cell;
  const double volume = sixfoldVolume(a, b, c, d);
  return { sixfoldVolume(point, b, c, d) / volume, sixfoldVolume(a, point, c, d) / volume,
    sixfoldVolume(a, b, point, d) / volume, sixfoldVolume(a, b, c, point) / volume };
}

std::array<double, 3> barycentric(const SimplexPoints<3>& cell, const Point3& point)
{
  const auto& [a, b, c] = cell;
  const Vector3 normal = twofoldAreaVector(a, b, c);
  const auto part = [&](const Point3& p, const Point3& q, const Point3& r)
  { return dot(twofoldAreaVector(p, q, r), normal) / squaredNorm(normal); };
  return { part(point, b, c), part(a, point, c), part(a, b, point) };
}

double overlap(const SimplexPoints<4>& a, const SimplexPoints<4>& b)
{
  return overlapOf<4>(a, measure(a), b, measure(b));
}

double overlap(const SimplexPoints<3>& a, const SimplexPoints<3>& b)
{
  const Vector3 normal = normalized(twofoldAreaVector(b[0], b[1], b[2]));
  if (dot(normal, twofoldAreaVector(a[0], a[1], a[2])) <= 0)
  {
    return 0;
  }
  SimplexPoints<3> projected = a;
  for (Point3& corner : projected)
  {
    corner = corner - dot(corner - b[0], normal) * normal;
  }
  return overlapOf<3>(projected, measure(projected), b, measure(b));
}

} // namespace cadrefine
