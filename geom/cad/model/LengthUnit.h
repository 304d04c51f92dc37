// Units of length, by their short names: "mm", "in".
#pragma once

#include <cadrefine/base/Vector3.h>

#include <array>
#include <string>

namespace cadrefine
{

struct LengthUnit
{
  const char* name;
  const char* plural; ///< The plural of its name, as text says it.
};

/// The units of engineers' meshes.
constexpr std::array<LengthUnit, 5> usualUnits{ { { "m", "metres" }, { "cm", "centimetres" },
  { "mm", "millimetres" }, { "in", "inches" }, { "ft", "feet" } } };

/// The usual short form ("mm", "in", ...) of a unit's name ("MILLIMETRE", "'INCH'", "feet"); a name
/// that is not known comes back in lower case.
std::string shortUnitName(const std::string& name);

/// Short name of a unit by its length in millimetres; empty where it is not a usual one.
std::string shortUnitName(double millimetres);

/// Length in millimetres of the unit of this short name; 0: not known.
double unitLength(const std::string& shortName);

/// Converts lengths from one unit to another. A quotient, so that millimetres in metres are the
/// doubles nearest to the decimal numbers.
struct LengthScale
{
  double from = 1; ///< Length of the unit that coordinates are in.
  double to = 1;   ///< Length of the unit that they are wanted in.

  double operator()(double length) const { return length * from / to; }
  Point3 operator()(const Point3& p) const
  {
    return { (*this)(p[0]), (*this)(p[1]), (*this)(p[2]) };
  }
  LengthScale back() const { return { to, from }; }
};

} // namespace cadrefine
