// One reader for each file format. Private to geom/cad.
#pragma once

#include <cadrefine/cad/import/ReadSteps.h>
#include <cadrefine/cad/model/CADReport.h>
#include <cadrefine/cad/readers/EntityAttributes.h>

#include <TopoDS_Shape.hxx>

#include <string>

namespace cadrefine
{

/// What a file holds, before any sewing or healing. Coordinates are the file's own numbers.
struct ReadShape
{
  TopoDS_Shape shape; ///< Null where nothing could be read.
  CADReport report;
  AttributeMap attributeMap;
};

/// Read a file of this format; each throws Error where the file as a whole cannot be read. Open
/// CASCADE prints, and keeps settings in global variables: for the program that reads CAD files
/// (IsolatedRun.h).
ReadShape readIges(const std::string& path, OptionalSteps& steps);
ReadShape readStep(const std::string& path, OptionalSteps& steps);
ReadShape readBrep(const std::string& path, OptionalSteps& steps);

} // namespace cadrefine
