#include <cadrefine/motion/ShapeEnergy.h>

#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cadrefine
{
namespace
{

/// eta = scale L / s^power is 1 for equilateral cells, with s six times the volume of a
/// tetrahedron, or twice the area of a triangle.
double scaleOf(int dimension)
{
  return dimension == 3 ? std::cbrt(4.0) / 12 : 1 / (2 * std::sqrt(3.0));
}

double powerOf(int dimension)
{
  return dimension == 3 ? 2.0 / 3.0 : 1.0;
}

/// The inverse mean ratio eta, from the sum of squared edge lengths and the regularised measure.
double inverseRatio(int dimension, double squaredLengths, double measure)
{
  const double root = std::cbrt(measure);
  return scaleOf(dimension) * squaredLengths / (dimension == 3 ? root * root : measure);
}

double regularised(double s, double delta)
{
  const double root = std::sqrt(s * s + 4 * delta * delta);
  return s >= 0 ? 0.5 * (s + root) : 2 * delta * delta / (root - s); // no cancellation
}

/// The vector x of the first `count` entries with (A + shift) x = -b, or none where A + shift is
/// not positive definite (Cholesky).
std::optional<Vector3> solve(std::array<Vector3, 3> a, const Vector3& b, int count, double shift)
{
  Vector3 y{};
  for (int i = 0; i < count; ++i)
  {
    a[i][i] += shift;
    for (int j = 0; j <= i; ++j)
    {
      double sum = a[i][j];
      for (int k = 0; k < j; ++k)
      {
        sum -= a[i][k] * a[j][k];
      }
      if (i == j && !(sum > 0))
      {
        return {};
      }
      a[i][j] = i == j ? std::sqrt(sum) : sum / a[j][j];
    }
    double sum = -b[i];
    for (int k = 0; k < i; ++k)
    {
      sum -= a[i][k] * y[k];
    }
    y[i] = sum / a[i][i];
  }
  for (int i = count - 1; i >= 0; --i)
  {
    for (int k = i + 1; k < count; ++k)
    {
      y[i] -= a[k][i] * y[k];
    }
    y[i] /= a[i][i];
  }
  return y;
}

} // namespace

Directions Directions::everywhere()
{
  return { { { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }, 3 };
}

Directions Directions::across(const Vector3& normal)
{
  const Vector3 n = normalized(normal);
  if (n == Vector3{})
  {
    return {};
  }
  const auto smallest = std::min_element(
    n.begin(), n.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  Vector3 axis{};
  axis[smallest - n.begin()] = 1;
  const Vector3 first = normalized(cross(n, axis));
  return { { { first, cross(n, first), {} } }, 2 };
}

Directions Directions::along(const Vector3& tangent)
{
  const Vector3 t = normalized(tangent);
  return { { { t, {}, {} } }, t == Vector3{} ? 0 : 1 };
}

double regularisation(double smallestMeasure)
{
  // Below 0.016 of mean ratio for tetrahedra. Some times more blurs the border between valid and
  // inverted, and less freezes tangled vertices.
  constexpr double small = 0.002;
  return smallestMeasure < small ? std::sqrt(small * (small - smallestMeasure)) : 0;
}

double equilateralMeasure(int dimension, double squaredLengths)
{
  return std::pow(scaleOf(dimension) * squaredLengths, 1 / powerOf(dimension));
}

void ShapeEnergy::addTetrahedron(const Point3& a, const Point3& b, const Point3& c, double delta)
{
  terms_.push_back({ { a, b, c }, squaredEdgeLengths(a, b, c), twofoldAreaVector(a, b, c), delta });
}

void ShapeEnergy::addTriangle(const Point3& a, const Point3& b, const Vector3& normal, double delta)
{
  terms_.push_back({ { a, b, {} }, squaredNorm(b - a), cross(normal, b - a), delta });
}

/// L is the sum of the squared edges by weights -n_i . n_j, n_i the gradient of the barycentric
/// coordinate of corner i in the reference: the squared Frobenius norm of the map, up to a factor.
void ShapeEnergy::addTetrahedron(const Point3& a, const Point3& b, const Point3& c, double delta,
  const std::array<Point3, 4>& reference)
{
  const auto& [o, p, q, r] = reference;
  const double size = sixfoldVolume(o, p, q, r);
  if (!(size > 0))
  {
    return addTetrahedron(a, b, c, delta);
  }
  const std::array<Vector3, 4> slopes{ twofoldAreaVector(p, r, q), twofoldAreaVector(o, q, r),
    twofoldAreaVector(o, r, p), twofoldAreaVector(o, p, q) };
  const double factor = std::pow(size, powerOf(3) - 2) / (3 * scaleOf(3));
  const auto weight = [&](int i, int j) { return -factor * dot(slopes[i], slopes[j]); };
  terms_.push_back({ { a, b, c },
    weight(0, 1) * squaredNorm(b - a) + weight(1, 2) * squaredNorm(c - b) +
      weight(0, 2) * squaredNorm(c - a),
    twofoldAreaVector(a, b, c), delta, { weight(0, 3), weight(1, 3), weight(2, 3) } });
}

void ShapeEnergy::addTriangle(const Point3& a, const Point3& b, const Vector3& normal, double delta,
  const std::array<Point3, 3>& reference)
{
  const auto& [o, p, q] = reference;
  const double size = dot(normal, twofoldAreaVector(o, p, q));
  if (!(size > 0))
  {
    return addTriangle(a, b, normal, delta);
  }
  const std::array<Vector3, 3> opposite{ q - p, o - q, p - o };
  const auto weight = [&, factor = 1 / (2 * scaleOf(2) * size)](int i, int j)
  { return -factor * dot(opposite[i], opposite[j]); };
  terms_.push_back({ { a, b, {} }, weight(0, 1) * squaredNorm(b - a), cross(normal, b - a), delta,
    { weight(0, 2), weight(1, 2), 0 } });
}

double ShapeEnergy::lengths(const Term& term, const Point3& x) const
{
  double sum = term.otherLengths;
  for (int k = 0; k < dimension_; ++k)
  {
    sum += term.weights[k] * squaredNorm(x - term.others[k]);
  }
  return sum;
}

/// The regularised inverse mean ratio of a cell; without regularisation infinite where the cell is
/// inverted or flat.
double ShapeEnergy::inverseRatioOf(const Term& term, const Point3& x) const
{
  const double h = regularised(dot(term.slope, x - term.others[0]), term.delta);
  return h > 0 ? inverseRatio(dimension_, lengths(term, x), h)
               : std::numeric_limits<double>::infinity();
}

double ShapeEnergy::raised(double eta) const
{
  double result = eta * eta;
  for (int exponent = 2; exponent < exponent_; exponent *= 2)
  {
    result *= result;
  }
  return result;
}

double ShapeEnergy::at(const Point3& x) const
{
  double sum = 0;
  for (const Term& term : terms_)
  {
    sum += raised(inverseRatioOf(term, x));
  }
  return sum;
}

double ShapeEnergy::largestAt(const Point3& x) const
{
  double largest = 0;
  for (const Term& term : terms_)
  {
    largest = std::max(largest, inverseRatioOf(term, x));
  }
  return largest;
}

/// With l = log eta: the derivatives of eta^n are n eta^n l' and n eta^n (n l' l'^T + l''), where
///   l'  = L'/L - (p/r) s',   r = sqrt(s^2 + 4 delta^2),
///   l'' = L''/L - L' L'^T / L^2 + p s / r^3 s' s'^T.
ShapeEnergy::Derivatives ShapeEnergy::derivativesAt(const Point3& x) const
{
  const double power = powerOf(dimension_);
  Derivatives sum;
  for (const Term& term : terms_)
  {
    const double s = dot(term.slope, x - term.others[0]);
    const double r = std::sqrt(s * s + 4 * term.delta * term.delta);
    const double length = lengths(term, x);
    const double eta = inverseRatio(dimension_, length, regularised(s, term.delta));
    Vector3 lengthSlope{};
    double weights = 0;
    for (int k = 0; k < dimension_; ++k)
    {
      lengthSlope = lengthSlope + 2.0 * term.weights[k] * (x - term.others[k]);
      weights += term.weights[k];
    }
    const Vector3 ofLength = (1 / length) * lengthSlope;
    const Vector3 ofMeasure = (1 / r) * term.slope; // no powers of r, which overflow
    const Vector3 slope = ofLength - power * ofMeasure;
    const double factor = exponent_ * raised(eta);
    for (int i = 0; i < 3; ++i)
    {
      sum.gradient[i] += factor * slope[i];
      sum.hessian[i][i] += factor * 2 * weights / length;
      for (int j = 0; j < 3; ++j)
      {
        sum.hessian[i][j] += factor * (exponent_ * slope[i] * slope[j] - ofLength[i] * ofLength[j] +
                                        power * (s / r) * ofMeasure[i] * ofMeasure[j]);
      }
    }
  }
  return sum;
}

Vector3 ShapeEnergy::step(const Point3& x, const Directions& directions) const
{
  const Derivatives whole = derivativesAt(x);
  Vector3 gradient{};
  std::array<Vector3, 3> hessian{};
  double squaredSize = 0; // of the Hessian by Frobenius' norm, which no rotation changes
  for (int i = 0; i < directions.count; ++i)
  {
    gradient[i] = dot(whole.gradient, directions.axes[i]);
    for (int j = 0; j < directions.count; ++j)
    {
      for (int k = 0; k < 3; ++k)
      {
        hessian[i][j] += directions.axes[i][k] * dot(whole.hessian[k], directions.axes[j]);
      }
      squaredSize += hessian[i][j] * hessian[i][j];
    }
  }
  const double size = std::sqrt(squaredSize);
  std::optional<Vector3> parts = solve(hessian, gradient, directions.count, 0);
  for (double shift = 1.0 / 64; !parts && shift <= 4; shift *= 4)
  {
    parts = solve(hessian, gradient, directions.count, shift * size);
  }
  Vector3 step{};
  for (int i = 0; i < directions.count && parts; ++i)
  {
    step = step + (*parts)[i] * directions.axes[i];
  }
  double farthest = 0;
  for (const Term& term : terms_)
  {
    for (int k = 0; k < dimension_; ++k)
    {
      farthest = std::max(farthest, distance(x, term.others[k]));
    }
  }
  const double length = norm(step);
  return length > 0.5 * farthest ? (0.5 * farthest / length) * step : step;
}

} // namespace cadrefine
