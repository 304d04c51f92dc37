#include <cadrefine/mesh/CellJacobian.h>

#include <cadrefine/mesh/Orientation.h>
#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cadrefine
{
namespace
{

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr int maximumHalvings = 256;

/// What is subtracted from each coefficient, so that what is left is positive for certain. With u
/// half of epsilon, and edges scaled to a 1-norm of at most 1: a scaled edge errs by 3 u, a
/// determinant of three by 14 u, the mean of two by 15 u. The sums for faces and the middle of a
/// hexahedron amplify that to at most 106 u. A halving adds 2 u.
constexpr double margin = (53 + maximumHalvings + 11) * epsilon;

/// Divides edges of one direction by the largest of their 1-norms, unless there is none.
template<std::size_t Count>
bool scaleToUnit(std::array<Vector3, Count>& edges)
{
  double largest = 0;
  for (const Vector3& edge : edges)
  {
    largest = std::max(largest, std::abs(edge[0]) + std::abs(edge[1]) + std::abs(edge[2]));
  }
  if (!(largest > 1e-300 && largest < 1e300))
  {
    return false;
  }
  const double factor = 1 / largest;
  for (Vector3& edge : edges)
  {
    edge = factor * edge;
  }
  return true;
}

/// A lower bound of the coefficient at a corner, negative where the exact one is not positive. It
/// is 0 where that is positive but lost in the margin: a 0 adds nothing to the rounding errors of
/// halvings, so that all over the cell they stay below what the margins of the others give.
template<class ExactSign>
double lowerBoundAtCorner(double coefficient, const ExactSign& exactSign)
{
  if (coefficient > margin)
  {
    return coefficient - margin;
  }
  return coefficient >= -margin && exactSign() > 0 ? 0 : -1;
}

/// The corner of a hexahedron at parameters i, j, k of 0 or 1.
constexpr int cornerAt(int i, int j, int k)
{
  return 4 * k + (j == 0 ? i : 3 - i);
}

/// The edges along each direction d. With e and f the next directions, cyclically, the edge at
/// parameters a of e and b of f is at a + 2 b.
using HexahedronEdges = std::array<std::array<Vector3, 4>, 3>;

HexahedronEdges edgesOf(const Hexahedron& corners)
{
  HexahedronEdges edges;
  for (int a = 0; a < 2; ++a)
  {
    for (int b = 0; b < 2; ++b)
    {
      const int place = a + 2 * b;
      edges[0][place] = corners[cornerAt(1, a, b)] - corners[cornerAt(0, a, b)];
      edges[1][place] = corners[cornerAt(b, 1, a)] - corners[cornerAt(b, 0, a)];
      edges[2][place] = corners[cornerAt(a, b, 1)] - corners[cornerAt(a, b, 0)];
    }
  }
  return edges;
}

/// A lower bound of the determinant of the unit vectors along three edges of a hexahedron, one of
/// each direction, and of the sign of the Jacobian: with m_d the means of the edges, and r_d how
/// far the others are from them, a determinant of three edges differs from that of the means by at
/// most the product of the |m_d| + r_d less that of the |m_d|. Not above 0 where it cannot tell, or
/// where products of squares may lose digits.
double boundByMeans(const HexahedronEdges& edges)
{
  constexpr double rounding = 1e-12; // far above that of what follows
  std::array<Vector3, 3> means;
  double lengths = 1;
  double longest = 1;
  for (int d = 0; d < 3; ++d)
  {
    const auto& e = edges[d];
    means[d] = 0.25 * ((e[0] + e[1]) + (e[2] + e[3]));
    const double square = squaredNorm(means[d]);
    if (!(square > 1e-60 && square < 1e60))
    {
      return 0;
    }
    const double radius =
      std::sqrt(std::max(std::max(squaredNorm(e[0] - means[d]), squaredNorm(e[1] - means[d])),
        std::max(squaredNorm(e[2] - means[d]), squaredNorm(e[3] - means[d]))));
    const double length = std::sqrt(square);
    lengths *= length;
    longest *= length + radius;
  }
  return (determinant(means[0], means[1], means[2]) + lengths) / longest - 1 - rounding;
}

double cornerCoefficient(const HexahedronEdges& edges, int i, int j, int k)
{
  return determinant(edges[0][j + 2 * k], edges[1][k + 2 * i], edges[2][i + 2 * j]);
}

/// The least determinant of the unit vectors along the edges at a corner, and along the mean edges.
/// Edges: scaled to 1 in each direction.
double leastOfUnitEdges(const HexahedronEdges& edges)
{
  std::array<Vector3, 3> means;
  std::array<std::array<double, 4>, 3> squares;
  for (int d = 0; d < 3; ++d)
  {
    const auto& e = edges[d];
    means[d] = (e[0] + e[1]) + (e[2] + e[3]);
    std::transform(e.begin(), e.end(), squares[d].begin(), squaredNorm);
  }
  const auto ofUnit = [](double value, double first, double second, double third)
  {
    const double product = first * second * third;
    return product > 0 ? value * std::abs(value) / product : 0;
  };
  double least =
    std::min(1.0, ofUnit(determinant(means[0], means[1], means[2]), squaredNorm(means[0]),
                    squaredNorm(means[1]), squaredNorm(means[2])));
  for (int n = 0; n < 8; ++n)
  {
    const int i = n & 1;
    const int j = n >> 1 & 1;
    const int k = n >> 2;
    least = std::min(least, ofUnit(cornerCoefficient(edges, i, j, k), squares[0][j + 2 * k],
                              squares[1][k + 2 * i], squares[2][i + 2 * j]));
  }
  return std::copysign(std::sqrt(std::abs(least)), least);
}

/// The Bernstein coefficient at the middle of edge a + 2 b of direction d.
double edgeCoefficient(const HexahedronEdges& edges, int d, int a, int b)
{
  const auto& next = edges[(d + 1) % 3];
  const auto& last = edges[(d + 2) % 3];
  return 0.5 * dot(edges[d][a + 2 * b],
                 cross(next[b], last[1 + 2 * a]) + cross(next[b + 2], last[2 * a]));
}

/// The Bernstein coefficients of degree 2 in each of three parameters: that of index p, q, r at
/// p + 3 q + 9 r.
using Coefficients = std::array<double, 27>;
constexpr std::array<int, 3> stride{ 1, 3, 9 };
constexpr std::array<int, 8> cornerPlaces{ 0, 2, 6, 8, 18, 20, 24, 26 };

/// No term of the determinant is of degree 2 in two parameters, as two of the three derivatives
/// would give it the same vector. So the sum of a face's coefficients with the weights (1, -2, 1) x
/// (1, -2, 1) vanishes, and that of all with (1, -2, 1) in the three directions: coefficients at
/// corners and edges give those in the middles.
Coefficients coefficientsOf(const HexahedronEdges& edges)
{
  Coefficients result;
  double cornerSum = 0;
  double edgeSum = 0;
  for (int n = 0; n < 8; ++n)
  {
    result[cornerPlaces[n]] = cornerCoefficient(edges, n & 1, n >> 1 & 1, n >> 2);
    cornerSum += result[cornerPlaces[n]];
  }
  for (int d = 0; d < 3; ++d)
  {
    for (int n = 0; n < 4; ++n)
    {
      const int a = n & 1;
      const int b = n >> 1;
      const int place = stride[d] + 2 * a * stride[(d + 1) % 3] + 2 * b * stride[(d + 2) % 3];
      result[place] = edgeCoefficient(edges, d, a, b);
      edgeSum += result[place];
    }
  }
  for (int d = 0; d < 3; ++d)
  {
    const int e = stride[(d + 1) % 3];
    const int f = stride[(d + 2) % 3];
    for (const int middle : { e + f, e + f + 2 * stride[d] })
    {
      const auto at = [&](int offset) { return result[middle + offset]; };
      result[middle] =
        (2 * (at(-e) + at(e) + at(-f) + at(f)) - (at(-e - f) + at(e - f) + at(f - e) + at(e + f))) /
        4;
    }
  }
  result[13] = (edgeSum - cornerSum) / 4;
  return result;
}

/// The direction in which the coefficients are farthest from linear.
int mostBentDirection(const Coefficients& c)
{
  std::array<double, 3> bend{};
  for (int d = 0; d < 3; ++d)
  {
    const int e = stride[(d + 1) % 3];
    const int f = stride[(d + 2) % 3];
    for (const int start : { 0, e, 2 * e, f, e + f, 2 * e + f, 2 * f, e + 2 * f, 2 * e + 2 * f })
    {
      const int middle = start + stride[d];
      bend[d] = std::max(bend[d], std::abs(c[start] - 2 * c[middle] + c[middle + stride[d]]));
    }
  }
  return static_cast<int>(std::max_element(bend.begin(), bend.end()) - bend.begin());
}

/// De Casteljau's algorithm: the coefficients on the two halves of the cell.
std::array<Coefficients, 2> halve(const Coefficients& c, int step)
{
  std::array<Coefficients, 2> halves{ c, c };
  for (int start = 0; start < 27; ++start)
  {
    if (start / step % 3 == 0)
    {
      const double low = 0.5 * (c[start] + c[start + step]);
      const double high = 0.5 * (c[start + step] + c[start + 2 * step]);
      const double middle = 0.5 * (low + high);
      halves[0][start + step] = low;
      halves[0][start + 2 * step] = middle;
      halves[1][start] = middle;
      halves[1][start + step] = high;
    }
  }
  return halves;
}

bool isNeverNegative(const Coefficients& coefficients, int& halvingsLeft)
{
  const auto isNegative = [](double coefficient) { return !(coefficient >= 0); };
  if (std::none_of(coefficients.begin(), coefficients.end(), isNegative))
  {
    return true;
  }
  if (std::any_of(cornerPlaces.begin(), cornerPlaces.end(),
        [&](int place) { return isNegative(coefficients[place]); }) ||
      halvingsLeft-- == 0)
  {
    return false;
  }
  const auto halves = halve(coefficients, stride[mostBentDirection(coefficients)]);
  return isNeverNegative(halves[0], halvingsLeft) && isNeverNegative(halves[1], halvingsLeft);
}

/// Whether a quadratic polynomial with these Bernstein coefficients is nowhere negative, in closed
/// form. Its rounding is below the margin.
bool isNeverNegative(double first, double middle, double last)
{
  return first >= 0 && last >= 0 && (middle >= 0 || middle * middle <= first * last);
}

/// The directions of a wedge: edges from corner 0 of each triangle to its other two, and from one
/// triangle to the other.
struct WedgeEdges
{
  explicit WedgeEdges(const Wedge& corners)
    : first{ corners[1] - corners[0], corners[4] - corners[3] },
      second{ corners[2] - corners[0], corners[5] - corners[3] }, across{ corners[3] - corners[0],
        corners[4] - corners[1], corners[5] - corners[2] }
  {
  }

  /// The Bernstein coefficients from one triangle to the other of twice its area times its normal.
  std::array<Vector3, 3> normals() const
  {
    return { cross(first[0], second[0]),
      0.5 * (cross(first[0], second[1]) + cross(first[1], second[0])), cross(first[1], second[1]) };
  }

  std::array<Vector3, 2> first;
  std::array<Vector3, 2> second;
  std::array<Vector3, 3> across;
};

/// Corner k of a quadrilateral or of a pyramid's base, the next and the previous one.
template<std::size_t Count>
std::array<Point3, 3> cornerOf(const std::array<Point3, Count>& corners, int k)
{
  return { corners[k], corners[(k + 1) % 4], corners[(k + 3) % 4] };
}

/// The least value, with the sign that tells whether the cell is valid.
double withSignOf(bool isValid, double least)
{
  return isValid ? std::max(least, std::numeric_limits<double>::min()) : std::min(0.0, least);
}

/// Factor that makes the sine at the corners of the equilateral triangle 1.
const double sineFactor = 2 / std::sqrt(3.0);

} // namespace

bool hasPositiveJacobian(const Hexahedron& corners)
{
  HexahedronEdges edges = edgesOf(corners);
  if (!(scaleToUnit(edges[0]) && scaleToUnit(edges[1]) && scaleToUnit(edges[2])))
  {
    return false;
  }
  if (boundByMeans(edges) > 0)
  {
    return true;
  }
  const Coefficients coefficients = coefficientsOf(edges);
  Coefficients bounds;
  std::transform(coefficients.begin(), coefficients.end(), bounds.begin(),
    [](double coefficient) { return coefficient - margin; });
  for (int n = 0; n < 8; ++n)
  {
    const int i = n & 1;
    const int j = n >> 1 & 1;
    const int k = n >> 2;
    const int place = cornerPlaces[n];
    bounds[place] = lowerBoundAtCorner(coefficients[place],
      [&]
      {
        const int sign = orientation(corners[cornerAt(i, j, k)], corners[cornerAt(1 - i, j, k)],
          corners[cornerAt(i, 1 - j, k)], corners[cornerAt(i, j, 1 - k)]);
        return (i + j + k) % 2 == 0 ? sign : -sign;
      });
  }
  int halvingsLeft = maximumHalvings;
  return isNeverNegative(bounds, halvingsLeft);
}

bool hasPositiveJacobian(const Wedge& corners)
{
  WedgeEdges edges(corners);
  if (!(scaleToUnit(edges.first) && scaleToUnit(edges.second) && scaleToUnit(edges.across)))
  {
    return false;
  }
  const auto normals = edges.normals();
  for (int k = 0; k < 3; ++k)
  {
    const Vector3& across = edges.across[k];
    const double first = lowerBoundAtCorner(dot(across, normals[0]),
      [&] { return orientation(corners[0], corners[1], corners[2], corners[3 + k]); });
    const double last = lowerBoundAtCorner(dot(across, normals[2]),
      [&] { return orientation(corners[3], corners[5], corners[4], corners[k]); });
    if (!isNeverNegative(first, dot(across, normals[1]) - margin, last))
    {
      return false;
    }
  }
  return true;
}

bool hasPositiveJacobian(const Pyramid& corners)
{
  for (int k = 0; k < 4; ++k)
  {
    const auto [here, next, previous] = cornerOf(corners, k);
    if (!isPositive(here, next, previous, corners[4]))
    {
      return false;
    }
  }
  return true;
}

bool isValidQuadrilateral(const Quadrilateral& corners, const Vector3& side)
{
  for (int k = 0; k < 4; ++k)
  {
    const auto [here, next, previous] = cornerOf(corners, k);
    if (turnOf(here, next, previous, side) <= 0)
    {
      return false;
    }
  }
  return true;
}

double scaledJacobian(const Hexahedron& corners, double enough)
{
  HexahedronEdges edges = edgesOf(corners);
  const double bound = boundByMeans(edges);
  if (bound >= enough && bound > 0)
  {
    return bound;
  }
  if (!(scaleToUnit(edges[0]) && scaleToUnit(edges[1]) && scaleToUnit(edges[2])))
  {
    return 0;
  }
  return withSignOf(bound > 0 || hasPositiveJacobian(corners), leastOfUnitEdges(edges));
}

double scaledJacobian(const Wedge& corners)
{
  double least = 1;
  for (int k = 0; k < 3; ++k)
  {
    const int next = (k + 1) % 3;
    const int last = (k + 2) % 3;
    const Vector3 across = normalized(corners[3 + k] - corners[k]);
    for (const int triangle : { 0, 3 })
    {
      const Point3& here = corners[triangle + k];
      least = std::min(
        least, sineFactor * determinant(across, normalized(corners[triangle + next] - here),
                              normalized(corners[triangle + last] - here)));
    }
  }
  return withSignOf(hasPositiveJacobian(corners), least);
}

double scaledJacobian(const Pyramid& corners)
{
  double least = 1;
  for (int k = 0; k < 4; ++k)
  {
    const auto [here, next, previous] = cornerOf(corners, k);
    const Vector3 up = normalized(corners[4] - here);
    const Vector3 upAtNext = normalized(corners[4] - next);
    least = std::min({ least,
      std::sqrt(2.0) * determinant(up, normalized(next - here), normalized(previous - here)),
      sineFactor * norm(cross(up, upAtNext)) });
  }
  return withSignOf(hasPositiveJacobian(corners), least);
}

double scaledJacobian(const Quadrilateral& corners, const Vector3& side)
{
  const Vector3 normal = normalized(twofoldAreaVector(corners, 4));
  double least = 1;
  for (int k = 0; k < 4; ++k)
  {
    const auto [here, next, previous] = cornerOf(corners, k);
    const double sine =
      std::abs(dot(normal, cross(normalized(next - here), normalized(previous - here))));
    least = std::min(least, turnOf(here, next, previous, side) * sine);
  }
  return withSignOf(isValidQuadrilateral(corners, side), least);
}

/// The volume as the mean of the Bernstein coefficients; those of a hexahedron at corners cancel
/// out.
double volume(const Hexahedron& corners)
{
  const HexahedronEdges edges = edgesOf(corners);
  double sum = 0;
  for (int d = 0; d < 3; ++d)
  {
    for (int n = 0; n < 4; ++n)
    {
      sum += edgeCoefficient(edges, d, n & 1, n >> 1);
    }
  }
  return sum / 12;
}

double volume(const Wedge& corners)
{
  const WedgeEdges edges(corners);
  const auto normals = edges.normals();
  return dot(edges.across[0] + edges.across[1] + edges.across[2],
           normals[0] + normals[1] + normals[2]) /
         18;
}

double volume(const Pyramid& corners)
{
  double sum = 0;
  for (int k = 0; k < 4; ++k)
  {
    const auto [here, next, previous] = cornerOf(corners, k);
    sum += sixfoldVolume(here, next, previous, corners[4]);
  }
  return sum / 12;
}

double area(const Quadrilateral& corners)
{
  return norm(cross(corners[2] - corners[0], corners[3] - corners[1])) / 2;
}

} // namespace cadrefine
