#include <cadrefine/nurbs/PatchView.h>

#include <cadrefine/nurbs/BernsteinBasis.h>

#include <type_traits>

namespace cadrefine
{
namespace
{

/// Two numbers that are worked on at once (a vector type of GCC and Clang).
using Pair = double __attribute__((vector_size(2 * sizeof(double))));

/// A point in homogeneous coordinates.
struct Quad
{
  Pair xy{};
  Pair zw{};
  double weight() const { return zw[1]; }
};

inline Quad operator*(double factor, const Quad& a)
{
  return { factor * a.xy, factor * a.zw };
}

inline Quad operator-(const Quad& a, const Quad& b)
{
  return { a.xy - b.xy, a.zw - b.zw };
}

inline void add(Quad& sum, double factor, const Quad& term)
{
  sum.xy += factor * term.xy;
  sum.zw += factor * term.zw;
}

inline Quad toQuad(const ControlPoint& p)
{
  return { Pair{ p[0], p[1] }, Pair{ p[2], p[3] } };
}

inline Vector3 spatial(const Quad& a)
{
  return { a.xy[0], a.xy[1], a.zw[0] };
}

/// Value and derivatives of the homogeneous numerator and weight.
struct HomogeneousDerivatives
{
  Quad value{}, u{}, v{}, uu{}, uv{}, vv{};
};

/// `U` and `V` are int, or a constant known to the compiler, which then unrolls all loops.
template<typename U, typename V>
void addDerivatives(
  const ControlPoint* point, U degreeU, V degreeV, double s, double t, HomogeneousDerivatives& h)
{
  BernsteinBasis alongU;
  BernsteinBasis alongV;
  bernsteinDerivatives(degreeU, s, alongU);
  bernsteinDerivatives(degreeV, t, alongV);
  for (int i = 0; i <= degreeU; ++i)
  {
    Quad row{};
    Quad rowFirst{};
    Quad rowSecond{};
    for (int j = 0; j <= degreeV; ++j, ++point)
    {
      const Quad p = toQuad(*point);
      add(row, alongV.value[j], p);
      if (degreeV > 0)
      {
        add(rowFirst, alongV.first[j], p);
      }
      if (degreeV > 1)
      {
        add(rowSecond, alongV.second[j], p);
      }
    }
    add(h.value, alongU.value[i], row);
    add(h.u, alongU.first[i], row);
    if (degreeU > 1)
    {
      add(h.uu, alongU.second[i], row);
    }
    if (degreeV > 0)
    {
      add(h.v, alongU.value[i], rowFirst);
      add(h.uv, alongU.first[i], rowFirst);
    }
    if (degreeV > 1)
    {
      add(h.vv, alongU.value[i], rowSecond);
    }
  }
}

template<typename U, typename V>
void addValue(const ControlPoint* point, U degreeU, V degreeV, double s, double t, Quad& sum)
{
  BasisValues alongU;
  BasisValues alongV;
  bernsteinValues(degreeU, s, alongU);
  bernsteinValues(degreeV, t, alongV);
  for (int i = 0; i <= degreeU; ++i)
  {
    Quad row{};
    for (int j = 0; j <= degreeV; ++j, ++point)
    {
      add(row, alongV[j], toQuad(*point));
    }
    add(sum, alongU[i], row);
  }
}

template<int degree>
using Constant = std::integral_constant<int, degree>;

/// Calls `function(degreeU, degreeV)` with constants for those that are at most 3.
template<typename Function>
auto withDegrees(const PatchView& patch, const Function& function)
{
  const auto withV = [&](auto degreeU)
  {
    switch (patch.degreeV)
    {
      case 0:
        return function(degreeU, Constant<0>());
      case 1:
        return function(degreeU, Constant<1>());
      case 2:
        return function(degreeU, Constant<2>());
      case 3:
        return function(degreeU, Constant<3>());
      default:
        return function(degreeU, patch.degreeV);
    }
  };
  switch (patch.degreeU)
  {
    case 1:
      return withV(Constant<1>());
    case 2:
      return withV(Constant<2>());
    case 3:
      return withV(Constant<3>());
    default:
      return withV(patch.degreeU);
  }
}

} // namespace

PatchView viewOf(const BezierPatch& patch)
{
  return { patch.points.data(), patch.degreeU, patch.degreeV };
}

PatchView viewOf(const BezierCurve& curve)
{
  return { curve.points.data(), static_cast<int>(curve.points.size()) - 1, 0 };
}

Point3 evaluateLocal(const PatchView& patch, double s, double t)
{
  Quad p;
  withDegrees(
    patch, [&](auto degreeU, auto degreeV) { addValue(patch.points, degreeU, degreeV, s, t, p); });
  return { p.xy[0] / p.weight(), p.xy[1] / p.weight(), p.zw[0] / p.weight() };
}

PatchDerivatives evaluateLocalDerivatives(const PatchView& patch, double s, double t)
{
  HomogeneousDerivatives h;
  withDegrees(patch,
    [&](auto degreeU, auto degreeV) { addDerivatives(patch.points, degreeU, degreeV, s, t, h); });
  const double weight = h.value.weight();
  const double inverse = 1.0 / weight;
  const Quad value = { h.value.xy / weight, h.value.zw / weight };
  const Quad u = inverse * (h.u - h.u.weight() * value);
  const Quad v = inverse * (h.v - h.v.weight() * value);
  const Quad uu = inverse * (h.uu - 2.0 * h.u.weight() * u - h.uu.weight() * value);
  const Quad uv = inverse * (h.uv - h.u.weight() * v - h.v.weight() * u - h.uv.weight() * value);
  const Quad vv = inverse * (h.vv - 2.0 * h.v.weight() * v - h.vv.weight() * value);
  return { spatial(value), spatial(u), spatial(v), spatial(uu), spatial(uv), spatial(vv) };
}

} // namespace cadrefine
