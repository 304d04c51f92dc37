#include <cadrefine/mesh/Quality.h>

#include <cmath>

namespace cadrefine
{

double sixfoldVolume(const Point3& a, const Point3& b, const Point3& c, const Point3& d)
{
  return determinant(d - a, b - a, c - a);
}

Vector3 twofoldAreaVector(const Point3& a, const Point3& b, const Point3& c)
{
  return cross(b - a, c - a);
}

double meanRatio(const Point3& a, const Point3& b, const Point3& c, const Point3& d)
{
  const double lengths = squaredEdgeLengths(a, b, c, d);
  const double threefoldVolume = sixfoldVolume(a, b, c, d) / 2;
  const double root = std::cbrt(threefoldVolume);
  return lengths > 0 ? std::copysign(12 * root * root / lengths, threefoldVolume) : 0;
}

double meanRatio(const Point3& a, const Point3& b, const Point3& c)
{
  const double lengths = squaredEdgeLengths(a, b, c);
  return lengths > 0 ? 2 * std::sqrt(3.0) * norm(twofoldAreaVector(a, b, c)) / lengths : 0;
}

double largestMeanRatioOver(const Point3& a, const Point3& b, const Point3& c)
{
  // Of an apex at height h over the centroid of a triangle of area A and squared edges S, three
  // times the volume is A h, and all squared edges are 4 S / 3 + 3 h^2.
  const double edges = squaredEdgeLengths(a, b, c);
  const double squaredArea = squaredNorm(twofoldAreaVector(a, b, c)) / 4;
  return edges > 0 ? 6 * std::cbrt(squaredArea * 2 * edges / 9) / edges : 0;
}

} // namespace cadrefine
