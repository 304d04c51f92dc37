// Reading CAD files.
#pragma once

#include "CADModel.h"

#include <memory>
#include <string>

namespace cadrefine
{

/// Reads an IGES (.igs, .iges), STEP (.stp, .step) or BREP (.brep) file: sews, heals and converts
/// to NURBS. What could not be read is listed in CADModel::unread(). Files that hold only curves
/// give a model of edges. The file is read in a child process (fork), so that one that crashes Open
/// CASCADE or sends it round in circles is an error too. Throws Error, which names the file and the
/// reason, where nothing can be read.
std::shared_ptr<const CADModel> readCADFile(const std::string& path);

} // namespace cadrefine
