#include <cadrefine/mesh/QualitySummary.h>

#include <cadrefine/mesh/Orientation.h>
#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <cmath>
#include <mutex>

namespace cadrefine
{
namespace
{

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Beyond these, a cube of squared lengths or a volume may have lost digits to underflow, or be
/// infinite.
constexpr double smallestCube = std::numeric_limits<double>::min() / (epsilon * epsilon * epsilon);
constexpr double largestCube = std::numeric_limits<double>::max();

/// With L the sum of the squared edge lengths of a tetrahedron, sixfoldVolume errs by less than
/// 4 epsilon L^(3/2): each difference of coordinates by epsilon / 2 of itself, products and sums
/// further, and all terms together are at most the product of three edges' 1-norms. This is the
/// square of eight times as much for half the value, over L^3.
constexpr double certainlyPositive = (16 * epsilon) * (16 * epsilon);

/// Of the cells so far.
class Summary
{
public:
  void add(const Point3& a, const Point3& b, const Point3& c, const Point3& d)
  {
    const double lengths = squaredEdgeLengths(a, b, c, d);
    const double cube = lengths * lengths * lengths;
    const double half = sixfoldVolume(a, b, c, d) / 2;
    const double part = half * half;
    if (half > 0 && part > certainlyPositive * cube && cube > smallestCube && cube < largestCube)
    {
      summary_.smallestCube = std::min(summary_.smallestCube, part / cube);
    }
    else
    {
      addByOne(a, b, c, d);
    }
  }

  const QualitySummary& result() const { return summary_; }

private:
  void addByOne(const Point3& a, const Point3& b, const Point3& c, const Point3& d)
  {
    summary_.invalidCells += orientation(a, b, c, d) <= 0;
    summary_.smallestRatio = std::min(summary_.smallestRatio, meanRatio(a, b, c, d));
  }

  QualitySummary summary_;
};

} // namespace

double QualitySummary::minimum() const
{
  return std::min(12 * std::cbrt(smallestCube), smallestRatio);
}

void QualitySummary::add(const QualitySummary& other)
{
  invalidCells += other.invalidCells;
  smallestRatio = std::min(smallestRatio, other.smallestRatio);
  smallestCube = std::min(smallestCube, other.smallestCube);
}

QualitySummary summariseTetrahedra(const SimplexMesh& mesh, const ParallelFor& parallelFor)
{
  QualitySummary result;
  std::mutex mutex;
  parallelFor(mesh.tetrahedra.size(), fineGrain,
    [&](std::size_t begin, std::size_t end)
    {
      Summary summary;
      const auto& p = mesh.points;
      for (std::size_t t = begin; t < end; ++t)
      {
        const auto [a, b, c, d] = mesh.tetrahedra[t];
        summary.add(p[a], p[b], p[c], p[d]);
      }
      const std::lock_guard<std::mutex> lock(mutex);
      result.add(summary.result());
    });
  return result;
}

} // namespace cadrefine
