// Writes faces as a designer's IGES file has them: side by side, without topology.
#pragma once

#include <TopoDS_Face.hxx>

#include <string>
#include <vector>

namespace aeroplane
{

struct NamedFace
{
  TopoDS_Face face;
  bool whole; ///< The face is its surface up to the border: no trim curves are written.
  const char* name;
  int color; ///< IGES colour number.
};

/// Whole faces become B-spline surfaces (entity 128), the others trimmed ones (144). Coordinates
/// are divided by `metre`; unit metre. The same faces give the same bytes. Throws
/// std::runtime_error where a face cannot be written.
void writeIges(const std::vector<NamedFace>& faces, const std::string& path);

} // namespace aeroplane
