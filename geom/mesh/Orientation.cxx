#include <cadrefine/mesh/Orientation.h>

#include <cadrefine/mesh/Quality.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <limits>

namespace cadrefine
{
namespace
{

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// With L the sum of the squared edge lengths, sixfoldVolume errs by less than 4 epsilon L^(3/2)
/// (see QualitySummary.cxx). This is the square of eight times as much.
constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double certain = (32 * epsilon) * (32 * epsilon);
/// With sums of squared lengths between these, nothing of that underflows or overflows.
constexpr double smallestLengths = 1e-80;
constexpr double largestLengths = 1e80;

/// Whether all coordinates are finite: rational arithmetic has no infinities.
template<class... Points>
bool areFinite(const Points&... points)
{
  double zero = 0;
  for (const Point3* point : { &points... })
  {
    zero += 0 * (*point)[0] + 0 * (*point)[1] + 0 * (*point)[2];
  }
  return zero == 0;
}

Kernel::Point_3 exact(const Point3& p)
{
  return { p[0], p[1], p[2] };
}

int turn(const Point3& a, const Point3& b, const Point3& c, int x, int y)
{
  using Point = Kernel::Point_2;
  return CGAL::orientation(Point(a[x], a[y]), Point(b[x], b[y]), Point(c[x], c[y]));
}

int signOf(double value)
{
  return (value > 0) - (value < 0);
}

} // namespace

int orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d)
{
  return areFinite(a, b, c, d) ? CGAL::orientation(exact(a), exact(b), exact(c), exact(d)) : 0;
}

bool isPositive(const Point3& a, const Point3& b, const Point3& c, const Point3& d)
{
  const double lengths = squaredEdgeLengths(a, b, c, d);
  const double volume = sixfoldVolume(a, b, c, d);
  if (lengths > smallestLengths && lengths < largestLengths &&
      volume * volume > certain * lengths * lengths * lengths)
  {
    return volume > 0;
  }
  return orientation(a, b, c, d) > 0;
}

std::array<int, 3> normalSigns(const Point3& a, const Point3& b, const Point3& c)
{
  if (!areFinite(a, b, c))
  {
    return {};
  }
  return { turn(a, b, c, 1, 2), turn(a, b, c, 2, 0), turn(a, b, c, 0, 1) };
}

int turnOf(const Point3& a, const Point3& b, const Point3& c, const Vector3& reference)
{
  const std::array<int, 3> signs = normalSigns(a, b, c);
  if (std::count(signs.begin(), signs.end(), 0) == 2)
  {
    int sign = 0;
    for (int k = 0; k < 3; ++k)
    {
      sign += signs[k] * signOf(reference[k]);
    }
    return sign;
  }
  return signs == std::array<int, 3>{} ? 0 : signOf(dot(twofoldAreaVector(a, b, c), reference));
}

} // namespace cadrefine
