#include <cadrefine/mesh/QualitySummary.h>

#include <cadrefine/mesh/CellState.h>

#include <algorithm>
#include <cmath>
#include <mutex>

namespace cadrefine
{
namespace
{

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Beyond these bounds, a cube of squared lengths or a volume may have lost digits to underflow, or
/// be infinite.
constexpr double smallestCube = std::numeric_limits<double>::min() / (epsilon * epsilon * epsilon);
constexpr double largestCube = std::numeric_limits<double>::max();

/// With L the sum of the squared edge lengths of a tetrahedron, sixfoldVolume errs by less than
/// 4 epsilon L^(3/2): each difference of coordinates by epsilon / 2 of itself, products and sums
/// further, and all terms together are at most the product of three edges' 1-norms. This is the
/// square of eight times as much for half the value, over L^3.
constexpr double certainlyPositive = (16 * epsilon) * (16 * epsilon);

/// Lower bounds of a quality above this do in its place: bricks need only be looked at once.
constexpr double practicallyOne = 1 - 1e-11;

/// The summary of the cells so far.
class Summary
{
public:
  void add(shapes::Tetrahedron, const std::array<Point3, 4>& p)
  {
    const auto& [a, b, c, d] = p;
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
      add(stateAt(shapes::Tetrahedron{}, p));
    }
  }

  template<class Shape>
  void add(Shape shape, const std::array<Point3, Shape::corners>& p)
  {
    const double enough = std::min(summary_.smallestRatio, practicallyOne);
    add(stateAt(shape, p, sideOf(shape, p, {}), enough));
  }

  const QualitySummary& result() const { return summary_; }

private:
  void add(const CellState& state)
  {
    summary_.invalidCells += !state.valid;
    summary_.smallestRatio = std::min(summary_.smallestRatio, state.quality);
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

QualitySummary summariseCells(const Mesh& mesh, const ParallelFor& parallelFor)
{
  QualitySummary result;
  std::mutex mutex;
  visitOwnShapes(mesh,
    [&](auto shape, const auto& cells)
    {
      parallelFor(cells.size(), fineGrain,
        [&](std::size_t begin, std::size_t end)
        {
          Summary summary;
          for (std::size_t c = begin; c < end; ++c)
          {
            summary.add(shape, cornersOf(cells[c], mesh.points));
          }
          const std::lock_guard<std::mutex> lock(mutex);
          result.add(summary.result());
        });
    });
  return result;
}

} // namespace cadrefine
