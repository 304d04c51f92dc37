#include <cadrefine/nurbs/BezierSubdivision.h>

namespace cadrefine
{
namespace
{

ControlPoint blend(const ControlPoint& a, const ControlPoint& b, double s)
{
  const double r = 1.0 - s;
  return { r * a[0] + s * b[0], r * a[1] + s * b[1], r * a[2] + s * b[2], r * a[3] + s * b[3] };
}

/// Keeps, or continues to, [0, s] of the curve with control points c[0], c[step], ...
void keepLower(ControlPoint* c, int degree, int step, double s)
{
  for (int r = 1; r <= degree; ++r)
  {
    for (int i = degree; i >= r; --i)
    {
      c[i * step] = blend(c[(i - 1) * step], c[i * step], s);
    }
  }
}

/// Keeps [s, 1] of such a curve.
void keepUpper(ControlPoint* c, int degree, int step, double s)
{
  for (int r = degree; r >= 1; --r)
  {
    for (int i = 0; i < r; ++i)
    {
      c[i * step] = blend(c[i * step], c[(i + 1) * step], s);
    }
  }
}

void keepRange(ControlPoint* c, int degree, int step, double s0, double s1)
{
  if (s1 != 1.0)
  {
    keepLower(c, degree, step, s1);
  }
  if (s0 != 0.0)
  {
    keepUpper(c, degree, step, s0 / s1);
  }
}

} // namespace

std::vector<ControlPoint> restrictPatch(const PatchView& patch, const ParameterRectangle& part)
{
  std::vector<ControlPoint> points(patch.points, patch.points + patch.count());
  const int columns = patch.degreeV + 1;
  for (int j = 0; j < columns; ++j)
  {
    keepRange(points.data() + j, patch.degreeU, columns, part.s0, part.s1);
  }
  for (int i = 0; i <= patch.degreeU; ++i)
  {
    keepRange(points.data() + i * columns, patch.degreeV, 1, part.t0, part.t1);
  }
  return points;
}

} // namespace cadrefine
