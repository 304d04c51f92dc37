#include "PatchView.h"

#include "BernsteinBasis.h"

#include <type_traits>

namespace cadrefine
{
namespace
{

inline void addScaled(ControlPoint& sum, double factor, const ControlPoint& term)
{
  for (int k = 0; k < 4; ++k)
  {
    sum[k] += factor * term[k];
  }
}

inline Vector3 spatial(const ControlPoint& a)
{
  return { a[0], a[1], a[2] };
}

/// Value and derivatives of the homogeneous numerator and weight.
struct HomogeneousDerivatives
{
  ControlPoint value{}, u{}, v{}, uu{}, uv{}, vv{};
};

/// `U` and `V` are int, or a constant known to the compiler, which then unrolls all loops.
template<typename U, typename V>
HomogeneousDerivatives homogeneousDerivatives(
  const ControlPoint* point, U degreeU, V degreeV, double s, double t)
{
  BernsteinBasis alongU;
  BernsteinBasis alongV;
  bernsteinDerivatives(degreeU, s, alongU);
  bernsteinDerivatives(degreeV, t, alongV);
  HomogeneousDerivatives h;
  for (int i = 0; i <= degreeU; ++i)
  {
    ControlPoint row{};
    ControlPoint rowFirst{};
    ControlPoint rowSecond{};
    for (int j = 0; j <= degreeV; ++j, ++point)
    {
      addScaled(row, alongV.value[j], *point);
      addScaled(rowFirst, alongV.first[j], *point);
      addScaled(rowSecond, alongV.second[j], *point);
    }
    addScaled(h.value, alongU.value[i], row);
    addScaled(h.u, alongU.first[i], row);
    addScaled(h.uu, alongU.second[i], row);
    addScaled(h.v, alongU.value[i], rowFirst);
    addScaled(h.uv, alongU.first[i], rowFirst);
    addScaled(h.vv, alongU.value[i], rowSecond);
  }
  return h;
}

template<typename U, typename V>
ControlPoint homogeneousValue(const ControlPoint* point, U degreeU, V degreeV, double s, double t)
{
  BasisValues alongU;
  BasisValues alongV;
  bernsteinValues(degreeU, s, alongU);
  bernsteinValues(degreeV, t, alongV);
  ControlPoint sum{};
  for (int i = 0; i <= degreeU; ++i)
  {
    ControlPoint row{};
    for (int j = 0; j <= degreeV; ++j, ++point)
    {
      addScaled(row, alongV[j], *point);
    }
    addScaled(sum, alongU[i], row);
  }
  return sum;
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
  const ControlPoint p = withDegrees(patch, [&](auto degreeU, auto degreeV)
    { return homogeneousValue(patch.points, degreeU, degreeV, s, t); });
  return { p[0] / p[3], p[1] / p[3], p[2] / p[3] };
}

PatchDerivatives evaluateLocalDerivatives(const PatchView& patch, double s, double t)
{
  const HomogeneousDerivatives h = withDegrees(patch, [&](auto degreeU, auto degreeV)
    { return homogeneousDerivatives(patch.points, degreeU, degreeV, s, t); });
  const double weight = h.value[3];
  const double inverse = 1.0 / weight;
  PatchDerivatives d;
  d.value = { h.value[0] / weight, h.value[1] / weight, h.value[2] / weight };
  d.u = inverse * (spatial(h.u) - h.u[3] * d.value);
  d.v = inverse * (spatial(h.v) - h.v[3] * d.value);
  d.uu = inverse * (spatial(h.uu) - 2.0 * h.u[3] * d.u - h.uu[3] * d.value);
  d.uv = inverse * (spatial(h.uv) - h.u[3] * d.v - h.v[3] * d.u - h.uv[3] * d.value);
  d.vv = inverse * (spatial(h.vv) - 2.0 * h.v[3] * d.v - h.vv[3] * d.value);
  return d;
}

} // namespace cadrefine
