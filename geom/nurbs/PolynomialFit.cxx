#include <cadrefine/nurbs/PolynomialFit.h>

#include <utility>

namespace cadrefine::fit
{
namespace
{

using Nodes = std::array<double, degree + 1>;
using Matrix = std::array<Nodes, degree + 1>;

Nodes makeNodes()
{
  Nodes result{};
  for (int i = 0; i <= degree; ++i)
  {
    result[i] = 0.5 - 0.5 * std::cos(M_PI * i / degree);
  }
  result[degree] = 1;
  return result;
}

/// Inverse of the matrix of the Bernstein polynomials at the nodes (Gauss-Jordan with pivots).
Matrix makeMatrix()
{
  Matrix a{};
  Matrix inverse{};
  for (int i = 0; i <= degree; ++i)
  {
    a[i] = bernstein(nodes()[i]);
    inverse[i][i] = 1;
  }
  for (int k = 0; k <= degree; ++k)
  {
    int pivot = k;
    for (int i = k + 1; i <= degree; ++i)
    {
      pivot = std::abs(a[i][k]) > std::abs(a[pivot][k]) ? i : pivot;
    }
    std::swap(a[k], a[pivot]);
    std::swap(inverse[k], inverse[pivot]);
    for (int i = 0; i <= degree; ++i)
    {
      const double factor = i == k ? 1 - 1 / a[k][k] : a[i][k] / a[k][k];
      for (int j = 0; j <= degree; ++j)
      {
        a[i][j] -= factor * a[k][j];
        inverse[i][j] -= factor * inverse[k][j];
      }
    }
  }
  return inverse;
}

} // namespace

std::array<double, degree + 1> bernstein(double x)
{
  std::array<double, degree + 1> b{ 1 };
  for (int n = 1; n <= degree; ++n)
  {
    for (int i = n; i >= 0; --i)
    {
      b[i] = (i > 0 ? x * b[i - 1] : 0) + (i < n ? (1 - x) * b[i] : 0);
    }
  }
  return b;
}

const std::array<double, degree + 1>& nodes()
{
  static const Nodes result = makeNodes();
  return result;
}

const std::array<std::array<double, degree + 1>, degree + 1>& valuesToCoefficients()
{
  static const Matrix result = makeMatrix();
  return result;
}

} // namespace cadrefine::fit
