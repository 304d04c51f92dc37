// The ranges of the filters' properties.
#pragma once

#include <limits>
#include <string>
#include <vector>

class vtkPointSet;

namespace cadrefine
{

/// Throws Error, which names the property and the range, unless the value is finite and within it.
void checkProperty(const char* name, double value, double lowest, double highest);

/// Throws Error unless the value is finite, and not below the lowest one if that is given.
inline void checkProperty(const char* name, double value, double lowest)
{
  checkProperty(name, value, lowest, std::numeric_limits<double>::infinity());
}
inline void checkProperty(const char* name, double value)
{
  checkProperty(name, value, -std::numeric_limits<double>::infinity());
}

/// Throws Error where the cells lack one of these arrays of numbers; it tells how to get it, and
/// which arrays there are. A rank without cells need not have any.
void checkCellArrays(vtkPointSet* mesh, const std::vector<std::string>& names);

/// Throws Error where the cells lack one of these arrays (ConservedArrays), or it is not of
/// floating point. A rank without cells need not have any.
void checkConservedArrays(vtkPointSet* mesh, const std::vector<std::string>& names);

/// Throws Error, which names the property, unless the six bounds, xmin xmax ymin ymax zmin zmax,
/// are finite, and no lower one is above its upper one.
void checkBox(const char* name, const double* bounds);

} // namespace cadrefine
