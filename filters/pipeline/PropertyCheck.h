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

/// The same without an upper bound, and without any.
inline void checkProperty(const char* name, double value, double lowest)
{
  checkProperty(name, value, lowest, std::numeric_limits<double>::infinity());
}
inline void checkProperty(const char* name, double value)
{
  checkProperty(name, value, -std::numeric_limits<double>::infinity());
}

/// Throws Error where the cells lack one of these arrays of numbers: how to get it, and which there
/// are. A rank without cells need not have any.
void checkCellArrays(vtkPointSet* mesh, const std::vector<std::string>& names);

/// Throws Error where the cells lack one of these arrays (ConservedArrays), or it is not of
/// floating point. A rank without cells need not have any.
void checkConservedArrays(vtkPointSet* mesh, const std::vector<std::string>& names);

/// Six bounds, xmin xmax ymin ymax zmin zmax: finite, and no lower one above its upper one.
void checkBox(const char* name, const double* bounds);

} // namespace cadrefine
