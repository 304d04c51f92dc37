// Arrays of points or cells as bytes, to be sent to another rank.
#pragma once

#include <vtkSmartPointer.h>

#include <vector>

class vtkDataSetAttributes;
class vtkTable;

namespace cadrefine
{

/// The arrays with their names, types, names of components, what they are active as (scalars, ...)
/// and values. Arrays of numbers keep their type and every bit; VTK's own messages, in which the
/// other ones (texts) go, have no signed characters and no whole numbers of 64 bits. Throws Error
/// where an array cannot be sent.
std::vector<char> bytesOf(vtkDataSetAttributes* attributes);

/// The arrays of these bytes as the columns of a table. Throws Error where the bytes are none of
/// bytesOf.
vtkSmartPointer<vtkTable> arraysOf(const std::vector<char>& bytes);

} // namespace cadrefine
