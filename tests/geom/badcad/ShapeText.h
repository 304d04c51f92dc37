// The text of shapes in the formats of CAD files, and changes of it.
#pragma once

#include "BadFiles.h"

#include <TopoDS_Shape.hxx>

#include <array>
#include <string>
#include <vector>

namespace badcad
{

/// What Open CASCADE writes into a file with such an extension; "" where it crashes.
std::string textOf(const TopoDS_Shape& shape, const std::string& extension);

/// A BREP file in binary.
std::string binaryTextOf(const TopoDS_Shape& shape);

/// One text, and what is put in its place.
using Change = std::array<std::string, 2>;

/// Adds the text with the first `from` made `to`, for each change. Throws std::logic_error where
/// there is none.
void addChanged(std::vector<BadFile>& files, const std::string& text, const std::string& extension,
  const std::vector<Change>& changes);

/// The same with every `from`.
void addChangedAll(std::vector<BadFile>& files, const std::string& text,
  const std::string& extension, const std::vector<Change>& changes);

} // namespace badcad
