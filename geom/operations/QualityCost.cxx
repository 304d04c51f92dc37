#include <cadrefine/operations/QualityCost.h>

#include <cadrefine/mesh/Quality.h>

#include <cmath>

namespace cadrefine
{

double largestMeanRatioOver(const Point3& a, const Point3& b, const Point3& c)
{
  // Of an apex at height h over the centroid of a triangle of area A and squared edges S, three
  // times the volume is A h, and all squared edges are 4 S / 3 + 3 h^2.
  const double edges = squaredNorm(b - a) + squaredNorm(c - b) + squaredNorm(a - c);
  const double squaredArea = squaredNorm(twofoldAreaVector(a, b, c)) / 4;
  return edges > 0 ? 6 * std::cbrt(squaredArea * 2 * edges / 9) / edges : 0;
}

} // namespace cadrefine
