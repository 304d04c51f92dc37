#include <cadrefine/cad/readers/iges/IgesParameterCheck.h>

#include <cadrefine/base/Vector3.h>
#include <cadrefine/nurbs/ModelCheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace cadrefine
{
namespace
{

using Values = std::vector<std::string>;

/// An integer, or a real whose exponent may be E or D; an empty parameter is a default.
bool isNumber(const std::string& value)
{
  std::string number = value;
  std::replace_if(
    number.begin(), number.end(), [](char c) { return c == 'D' || c == 'd'; }, 'E');
  const std::string allowed = "0123456789+-.Ee";
  if (number.find_first_not_of(allowed) != std::string::npos)
  {
    return false;
  }
  char* end = nullptr;
  std::strtod(number.c_str(), &end);
  return *end == '\0';
}

double numberAt(const Values& values, std::size_t at)
{
  std::string number = values[at];
  std::replace_if(
    number.begin(), number.end(), [](char c) { return c == 'D' || c == 'd'; }, 'E');
  return std::strtod(number.c_str(), nullptr);
}

std::string checkNumbers(const Values& values)
{
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    if (!isNumber(values[i]))
    {
      return "parameter " + std::to_string(i) + " is '" + values[i].substr(0, 30) +
             "', not a number";
    }
    if (!(std::abs(numberAt(values, i)) <= largestCoordinate))
    {
      return "parameter " + std::to_string(i) + " is " + values[i].substr(0, 30) +
             ", which is beyond 1e50";
    }
  }
  return {};
}

bool isInteger(const std::string& value)
{
  return value.find_first_not_of("0123456789+-") == std::string::npos;
}

/// One parameter direction of a spline: its last index and its degree.
struct Direction
{
  long last = 0;
  long degree = 0;
  long poles() const { return last + 1; }
  long knots() const { return last + degree + 2; }
};

std::string checkDirection(const Direction& d)
{
  constexpr long mostPoles = 10000000;
  constexpr long highestDegree = 25;
  if (d.degree < 1 || d.degree > highestDegree)
  {
    return "degree " + std::to_string(d.degree) + " is not between 1 and 25";
  }
  if (d.last < d.degree || d.last >= mostPoles)
  {
    return std::to_string(d.poles()) + " control points do not suit degree " +
           std::to_string(d.degree);
  }
  return {};
}

std::string checkKnots(const Values& values, std::size_t from, long count)
{
  for (std::size_t i = from + 1; i < from + static_cast<std::size_t>(count); ++i)
  {
    if (numberAt(values, i) < numberAt(values, i - 1))
    {
      return "the knots decrease at parameter " + std::to_string(i);
    }
  }
  // Open CASCADE takes parameters as near to each other as that for one.
  constexpr double least = 1e-9;
  const double range =
    numberAt(values, from + static_cast<std::size_t>(count) - 1) - numberAt(values, from);
  return range <= 0 ? "all knots are equal" : range < least ? "the knots lie within 1e-9" : "";
}

std::string checkWeights(const Values& values, std::size_t from, long count)
{
  for (std::size_t i = from; i < from + static_cast<std::size_t>(count); ++i)
  {
    if (!(numberAt(values, i) > 0))
    {
      return "the weight at parameter " + std::to_string(i) + " is not positive";
    }
  }
  return {};
}

/// Types 126 and 128: numbers of control points, degrees and flags, then knots, weights, points.
std::string checkSpline(const Values& values, std::size_t directions)
{
  const std::size_t header = directions == 1 ? 7 : 10;
  if (values.size() < header)
  {
    return "has only " + std::to_string(values.size()) + " parameters";
  }
  if (!std::all_of(values.begin() + 1, values.begin() + 1 + 2 * directions, isInteger))
  {
    return "its counts and degrees are not integers";
  }
  long poles = 1;
  std::size_t needed = header;
  std::vector<Direction> sizes;
  for (std::size_t k = 0; k < directions; ++k)
  {
    const Direction d{ std::atol(values[1 + k].c_str()),
      std::atol(values[1 + directions + k].c_str()) };
    std::string reason = checkDirection(d);
    if (!reason.empty())
    {
      return reason;
    }
    sizes.push_back(d);
    poles *= d.poles();
    needed += static_cast<std::size_t>(d.knots());
  }
  const std::size_t weights = needed;
  needed += 4 * static_cast<std::size_t>(poles);
  if (values.size() < needed)
  {
    return "has " + std::to_string(values.size()) + " parameters, but needs " +
           std::to_string(needed);
  }
  std::size_t at = header;
  for (const Direction& d : sizes)
  {
    std::string reason = checkKnots(values, at, d.knots());
    if (!reason.empty())
    {
      return reason;
    }
    at += static_cast<std::size_t>(d.knots());
  }
  return checkWeights(values, weights, poles);
}

/// Type 124, by rows with the translation last. Open CASCADE takes rows of equal length that stand
/// at right angles to 1e-4, and leaves out any other matrix.
std::string checkMatrix(const Values& values)
{
  constexpr double precision = 1e-4;
  constexpr std::size_t count = 13;
  if (values.size() < count)
  {
    return "has " + std::to_string(values.size()) + " parameters, but needs 13";
  }
  std::array<Vector3, 3> rows{};
  double length = 0;
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    rows[i] = { numberAt(values, 4 * i + 1), numberAt(values, 4 * i + 2),
      numberAt(values, 4 * i + 3) };
    length += norm(rows[i]) / 3;
  }
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    const double product = dot(rows[i], rows[(i + 1) % rows.size()]);
    if (!(length > precision) || std::abs(norm(rows[i]) - length) > precision * length ||
        std::abs(product) > precision * length * length)
    {
      return "the matrix distorts shapes";
    }
  }
  return {};
}

} // namespace

std::string checkIgesParameters(int type, const IgesParameters& parameters)
{
  const bool isGeometry = (type >= 100 && type < 200) || (type >= 502 && type <= 514);
  if (!isGeometry)
  {
    return {};
  }
  if (parameters.values.empty() || std::atoi(parameters.values[0].c_str()) != type)
  {
    return "its parameters do not begin with its type";
  }
  std::string reason = checkNumbers(parameters.values);
  if (reason.empty() && type == 124)
  {
    return checkMatrix(parameters.values);
  }
  if (!reason.empty() || (type != 126 && type != 128))
  {
    return reason;
  }
  return checkSpline(parameters.values, type == 126 ? 1 : 2);
}

} // namespace cadrefine
