// Rectangles of parameters. Private to geom/nurbs.
#pragma once

namespace cadrefine
{

/// [s0, s1] x [t0, t1], of local or of the face's own parameters.
struct ParameterRectangle
{
  double s0 = 0;
  double s1 = 1;
  double t0 = 0;
  double t1 = 1;

  double width() const { return s1 - s0; }
  double height() const { return t1 - t0; }
  double middleS() const { return 0.5 * (s0 + s1); }
  double middleT() const { return 0.5 * (t0 + t1); }
  /// The lower or upper half, cut across s or across t.
  ParameterRectangle half(bool acrossS, bool upper) const
  {
    ParameterRectangle part = *this;
    if (acrossS)
    {
      (upper ? part.s0 : part.s1) = middleS();
    }
    else
    {
      (upper ? part.t0 : part.t1) = middleT();
    }
    return part;
  }
};

} // namespace cadrefine
