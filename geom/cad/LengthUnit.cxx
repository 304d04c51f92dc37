#include "LengthUnit.h"

#include <cctype>
#include <cmath>
#include <map>

namespace cadrefine
{

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
  static const std::map<double, const char*> names{ { 1e-6, "nm" }, { 1e-3, "um" }, { 1, "mm" },
    { 10, "cm" }, { 100, "dm" }, { 1e3, "m" }, { 1e6, "km" }, { 25.4, "in" }, { 0.0254, "mil" },
    { 304.8, "ft" }, { 1609344, "mi" } };
  for (const auto& [length, name] : names)
  {
    if (std::abs(millimetres - length) < 1e-6 * length)
    {
      return name;
    }
  }
  return {};
}

} // namespace cadrefine
