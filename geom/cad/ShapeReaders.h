// One reader for each file format. Private to geom/cad.
#pragma once

#include "CADModel.h"

#include <TopoDS_Shape.hxx>

#include <string>
#include <vector>

namespace cadrefine
{

/// What a file holds, before any sewing or healing. Coordinates are the file's own numbers.
struct ReadShape
{
  TopoDS_Shape shape; ///< Null where nothing could be read.
  std::string unit;
  std::vector<UnreadEntity> unread;
};

/// Each throws Error where the file as a whole cannot be read. Not for concurrent use: Open
/// CASCADE's readers keep their settings in global variables.
ReadShape readIges(const std::string& path);
ReadShape readStep(const std::string& path);
ReadShape readBrep(const std::string& path);

} // namespace cadrefine
