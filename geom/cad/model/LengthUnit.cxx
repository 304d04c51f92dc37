#include <cadrefine/cad/model/LengthUnit.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

namespace cadrefine
{
namespace
{

/// The lengths of units in millimetres.
const std::map<std::string, double>& lengths()
{
  static const std::map<std::string, double> byName{ { "nm", 1e-6 }, { "um", 1e-3 },
    { "mil", 0.0254 }, { "mm", 1 }, { "cm", 10 }, { "in", 25.4 }, { "dm", 100 }, { "ft", 304.8 },
    { "m", 1e3 }, { "km", 1e6 }, { "mi", 1609344 } };
  return byName;
}

} // namespace

std::string shortUnitName(const std::string& name)
{
  static const std::map<std::string, const char*> names{ { "millimetre", "mm" },
    { "millimeter", "mm" }, { "metre", "m" }, { "meter", "m" }, { "centimetre", "cm" },
    { "centimeter", "cm" }, { "kilometre", "km" }, { "kilometer", "km" }, { "micrometre", "um" },
    { "micrometer", "um" }, { "micron", "um" }, { "nanometre", "nm" }, { "decimetre", "dm" },
    { "inch", "in" }, { "inches", "in" }, { "foot", "ft" }, { "feet", "ft" }, { "mile", "mi" } };
  std::string lower;
  for (const unsigned char c : name)
  {
    if (std::isalnum(c))
    {
      lower += static_cast<char>(std::tolower(c));
    }
  }
  const auto found = names.find(lower);
  return found == names.end() ? lower : found->second;
}

std::string shortUnitName(double millimetres)
{
  const auto found = std::find_if(lengths().begin(), lengths().end(),
    [&](const auto& unit) { return std::abs(millimetres - unit.second) < 1e-6 * unit.second; });
  return found == lengths().end() ? std::string() : found->first;
}

double unitLength(const std::string& shortName)
{
  const auto found = lengths().find(shortName);
  return found == lengths().end() ? 0 : found->second;
}

} // namespace cadrefine
