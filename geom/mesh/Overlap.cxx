#include <cadrefine/mesh/Overlap.h>

#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cadrefine
{
namespace
{

template<std::size_t Corners>
using Coordinates = std::array<double, Corners>;

/// The barycentric coordinates of the corners of a simplex in another one.
template<std::size_t Corners>
using Piece = std::array<Coordinates<Corners>, Corners>;

/// How far along the way from `in` to `out` coordinate `k` is 0.
template<std::size_t Corners>
double crossingAt(const Coordinates<Corners>& in, const Coordinates<Corners>& out, std::size_t k)
{
  return in[k] / (in[k] - out[k]);
}

/// The point on the way from `in` to `out` where coordinate `k` is 0.
template<std::size_t Corners>
Coordinates<Corners> crossing(
  const Coordinates<Corners>& in, const Coordinates<Corners>& out, std::size_t k)
{
  const double t = crossingAt<Corners>(in, out, k);
  Coordinates<Corners> point;
  for (std::size_t i = 0; i < Corners; ++i)
  {
    point[i] = (1 - t) * in[i] + t * out[i];
  }
  point[k] = 0;
  return point;
}

/// A piece where coordinate `k` is positive at the first `inside` corners, neither none nor all.
/// The part where it is positive is a smaller simplex or a prism, of Corners - 1 simplices.
template<std::size_t Corners>
struct Cut
{
  Piece<Corners> piece;
  std::size_t inside;
  std::size_t k;

  std::size_t count() const { return inside == 1 ? 1 : Corners - 1; }
};

/// How large the simplices of simplicesOf are, in parts of the piece.
template<std::size_t Corners>
std::array<double, Corners - 1> partsOf(const Cut<Corners>& cut)
{
  const auto at = [&](std::size_t in, std::size_t out)
  { return crossingAt<Corners>(cut.piece[in], cut.piece[out], cut.k); };
  std::array<double, Corners - 1> parts{};
  if (cut.inside == 1)
  {
    parts[0] = 1;
    for (std::size_t i = 1; i < Corners; ++i)
    {
      parts[0] *= at(0, i);
    }
  }
  else if (cut.inside + 1 == Corners)
  {
    double beyond = 1; // the part that those after this one leave
    for (std::size_t i = cut.inside; i-- > 0;)
    {
      parts[i] = beyond * at(i, cut.inside);
      beyond *= 1 - at(i, cut.inside);
    }
  }
  else if constexpr (Corners == 4)
  {
    parts = { at(1, 2) * at(1, 3), at(0, 2) * (1 - at(1, 2)) * at(1, 3),
      at(0, 2) * at(0, 3) * (1 - at(1, 3)) };
  }
  return parts;
}

/// The simplices of the part where the coordinate is positive; each one of a prism has some corners
/// of one of two facets, and the others of the other.
template<std::size_t Corners>
std::array<Piece<Corners>, Corners - 1> simplicesOf(const Cut<Corners>& cut)
{
  const auto cross = [&](std::size_t in, std::size_t out)
  { return crossing<Corners>(cut.piece[in], cut.piece[out], cut.k); };
  std::array<Piece<Corners>, Corners - 1> result;
  if (cut.inside == 1)
  {
    result[0][0] = cut.piece[0];
    for (std::size_t i = 1; i < Corners; ++i)
    {
      result[0][i] = cross(0, i);
    }
    return result;
  }
  std::array<Coordinates<Corners>, Corners - 1> one;
  std::array<Coordinates<Corners>, Corners - 1> other;
  for (std::size_t i = 0; i + 1 < Corners; ++i)
  {
    const bool isTriangle = cut.inside + 1 == Corners; // else an edge with its two triangles
    one[i] = isTriangle ? cut.piece[i] : i == 0 ? cut.piece[0] : cross(0, i + 1);
    other[i] = isTriangle ? cross(i, cut.inside) : i == 0 ? cut.piece[1] : cross(1, i + 1);
  }
  for (std::size_t s = 0; s + 1 < Corners; ++s)
  {
    std::copy(one.begin(), one.begin() + s + 1, result[s].begin());
    std::copy(other.begin() + s, other.end(), result[s].begin() + s + 1);
  }
  return result;
}

/// How many corners have coordinate `k` positive, and whether one has it negative.
struct Sides
{
  std::size_t inside = 0;
  bool isCut = false;
};

template<std::size_t Corners>
Sides sidesOf(const Piece<Corners>& piece, std::size_t k)
{
  Sides sides;
  for (const Coordinates<Corners>& corner : piece)
  {
    sides.inside += corner[k] > 0;
    sides.isCut = sides.isCut || corner[k] < 0;
  }
  return sides;
}

/// The part of a piece where all coordinates are positive, given that those before `k` are. The
/// last cut takes no new pieces.
template<std::size_t Corners>
double partInside(const Piece<Corners>& piece, std::size_t k)
{
  Cut<Corners> cut{ piece, 0, Corners };
  bool isLast = true;
  for (; k < Corners; ++k)
  {
    const Sides sides = sidesOf<Corners>(piece, k);
    if (sides.inside == 0)
    {
      return 0;
    }
    if (sides.isCut && cut.k < Corners)
    {
      isLast = false;
    }
    else if (sides.isCut)
    {
      cut.k = k;
      cut.inside = sides.inside;
    }
  }
  if (cut.k == Corners)
  {
    return 1;
  }
  std::size_t in = 0;
  std::size_t out = cut.inside;
  for (const Coordinates<Corners>& corner : piece)
  {
    cut.piece[corner[cut.k] > 0 ? in++ : out++] = corner;
  }
  const auto parts = partsOf<Corners>(cut);
  if (isLast)
  {
    return std::accumulate(parts.begin(), parts.end(), 0.0);
  }
  const auto simplices = simplicesOf<Corners>(cut);
  double sum = 0;
  for (std::size_t s = 0; s < cut.count(); ++s)
  {
    sum += parts[s] * partInside<Corners>(simplices[s], cut.k + 1);
  }
  return sum;
}

/// The corners of `cell` in the coordinates of `frame`.
template<std::size_t Corners>
Piece<Corners> within(const SimplexFrame<Corners>& frame, const SimplexPoints<Corners>& cell)
{
  Piece<Corners> piece;
  for (std::size_t i = 0; i < Corners; ++i)
  {
    piece[i] = frame.coordinates(cell[i]);
  }
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

/// The overlap of simplices in one space.
template<std::size_t Corners>
double overlapOf(const SimplexFrame<Corners>& one, const SimplexFrame<Corners>& other)
{
  const bool isOneSmaller = one.size() <= other.size();
  const SimplexFrame<Corners>& small = isOneSmaller ? one : other;
  const SimplexFrame<Corners>& large = isOneSmaller ? other : one;
  if (!(small.size() > 0) || !std::isfinite(large.size()))
  {
    return 0;
  }
  const Piece<Corners> piece = within<Corners>(large, small.points());
  if (isApart<Corners>(piece) || isApart<Corners>(within<Corners>(small, large.points())))
  {
    return 0;
  }
  return std::min(partInside<Corners>(piece, 0), 1.0) * small.size();
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

template<std::size_t Corners>
SimplexFrame<Corners>::SimplexFrame(const SimplexPoints<Corners>& points)
  : points_(points), size_(measure(points))
{
  if (!(size_ > 0))
  {
    return;
  }
  const Vector3 b = points[1] - points[0];
  const Vector3 c = points[2] - points[0];
  if constexpr (Corners == 4)
  {
    const Vector3 d = points[3] - points[0];
    const double part = 1 / determinant(d, b, c);
    gradients_ = { part * cross(c, d), part * cross(d, b), part * cross(b, c) };
  }
  else
  {
    const Vector3 normal = cross(b, c);
    const double part = 1 / squaredNorm(normal);
    gradients_ = { part * cross(c, normal), part * cross(normal, b) };
  }
}

template class SimplexFrame<3>;
template class SimplexFrame<4>;

double overlap(const SimplexFrame<4>& a, const SimplexFrame<4>& b)
{
  return overlapOf<4>(a, b);
}

double overlap(const SimplexFrame<3>& a, const SimplexFrame<3>& b)
{
  const auto areaVector = [](const SimplexPoints<3>& cell)
  { return twofoldAreaVector(cell[0], cell[1], cell[2]); };
  const Vector3 normal = normalized(areaVector(b.points()));
  if (!(dot(normal, areaVector(a.points())) > 0))
  {
    return 0;
  }
  SimplexPoints<3> projected = a.points();
  for (Point3& corner : projected)
  {
    corner = corner - dot(corner - b.points()[0], normal) * normal;
  }
  return overlapOf<3>(SimplexFrame<3>(projected), b);
}

} // namespace cadrefine
