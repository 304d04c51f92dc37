#include <cadrefine/cad/extraction/ParameterMap.h>

#include <algorithm>
#include <cmath>

namespace cadrefine
{

ParameterMap ParameterMap::ofAngles(std::vector<double> knots)
{
  ParameterMap map;
  map.knots_ = std::move(knots);
  return map;
}

double ParameterMap::operator()(double parameter) const
{
  if (this->isIdentity() || parameter <= this->knots_.front() || parameter >= this->knots_.back())
  {
    return parameter;
  }
  const auto upper = std::upper_bound(this->knots_.begin(), this->knots_.end(), parameter);
  const double from = *(upper - 1);
  const double width = *upper - from;
  const double x = std::sin(0.5 * (parameter - from));
  const double y = std::sin(0.5 * (width - (parameter - from)));
  return from + width * x / (x + y);
}

} // namespace cadrefine
