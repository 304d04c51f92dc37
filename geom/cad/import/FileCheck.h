// What can be told of a CAD file before it is read. Private to geom/cad.
#pragma once

#include <optional>
#include <string>

namespace cadrefine
{

enum class CADFormat
{
  Iges,
  Step,
  Brep
};

/// The CAD format of a file by its extension; none for that of another kind of file.
std::optional<CADFormat> formatOf(const std::string& path);

/// The format of the file, by its extension. Throws Error where it is missing, is no file, may not
/// be read, is empty, has another extension, does not begin as such a file does, or is a text with
/// a hole. Work: reads the file once; memory: a page.
CADFormat checkFile(const std::string& path);

} // namespace cadrefine
