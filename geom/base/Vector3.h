// Fixed-size vectors of the numerical core.
#pragma once

#include <array>
#include <cmath>

namespace cadrefine
{

using Point3 = std::array<double, 3>;
using Vector3 = std::array<double, 3>;
using Point2 = std::array<double, 2>;

inline Vector3 operator+(const Vector3& a, const Vector3& b)
{
  return { a[0] + b[0], a[1] + b[1], a[2] + b[2] };
}

inline Vector3 operator-(const Vector3& a, const Vector3& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}

inline Vector3 operator*(double s, const Vector3& a)
{
  return { s * a[0], s * a[1], s * a[2] };
}

inline double dot(const Vector3& a, const Vector3& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Vector3 cross(const Vector3& a, const Vector3& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}

/// The determinant of the matrix with these columns.
inline double determinant(const Vector3& a, const Vector3& b, const Vector3& c)
{
  return dot(a, cross(b, c));
}

inline bool isFinite(const Vector3& a)
{
  return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]);
}

inline double squaredNorm(const Vector3& a)
{
  return dot(a, a);
}

inline double norm(const Vector3& a)
{
  return std::sqrt(squaredNorm(a));
}

inline double distance(const Point3& a, const Point3& b)
{
  return norm(a - b);
}

/// The unit vector along `a`, or the zero vector where `a` is zero.
inline Vector3 normalized(const Vector3& a)
{
  const double length = norm(a);
  return length > 0 ? (1.0 / length) * a : Vector3{};
}

} // namespace cadrefine
