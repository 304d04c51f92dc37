#include "PatchView.h"

#include "BernsteinBasis.h"

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

HomogeneousDerivatives homogeneousDerivatives(const PatchView& patch, double s, double t)
{
  BernsteinBasis alongU;
  BernsteinBasis alongV;
  bernsteinDerivatives(patch.degreeU, s, alongU);
  bernsteinDerivatives(patch.degreeV, t, alongV);
  HomogeneousDerivatives h;
  const ControlPoint* point = patch.points;
  for (int i = 0; i <= patch.degreeU; ++i)
  {
    ControlPoint row{};
    ControlPoint rowFirst{};
    ControlPoint rowSecond{};
    for (int j = 0; j <= patch.degreeV; ++j, ++point)
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
  BasisValues alongU;
  BasisValues alongV;
  bernsteinValues(patch.degreeU, s, alongU);
  bernsteinValues(patch.degreeV, t, alongV);
  ControlPoint sum{};
  const ControlPoint* point = patch.points;
  for (int i = 0; i <= patch.degreeU; ++i)
  {
    ControlPoint row{};
    for (int j = 0; j <= patch.degreeV; ++j, ++point)
    {
      addScaled(row, alongV[j], *point);
    }
    addScaled(sum, alongU[i], row);
  }
  return { sum[0] / sum[3], sum[1] / sum[3], sum[2] / sum[3] };
}

PatchDerivatives evaluateLocalDerivatives(const PatchView& patch, double s, double t)
{
  const HomogeneousDerivatives h = homogeneousDerivatives(patch, s, t);
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
