// From the parameters of an analytic curve to those of its rational Bezier pieces. Private to
// geom/cad.
#pragma once

#include <vector>

namespace cadrefine
{

/// A circle's angle and the parameter of its rational quadratic arcs agree at the ends of the arcs
/// only; the other curves keep their parameter. (For an arc of half angle a, whose middle weight is
/// cos a, the local parameter of the angle x from its start is
/// sin(x/2) / (sin(x/2) + sin(a - x/2)); Piegl & Tiller, The NURBS Book, 7.3.)
class ParameterMap
{
public:
  ParameterMap() = default;
  /// Angles over arcs that meet at `knots`, ascending.
  static ParameterMap ofAngles(std::vector<double> knots);

  bool isIdentity() const { return this->knots_.empty(); }
  double operator()(double parameter) const;
  /// Where the map is not smooth.
  const std::vector<double>& knots() const { return this->knots_; }

private:
  std::vector<double> knots_;
};

} // namespace cadrefine
