// Reading CAD files.
#pragma once

#include <cadrefine/cad/model/CADModel.h>

#include <memory>
#include <string>
#include <vector>

namespace cadrefine
{

/// Reads an IGES (.igs, .iges), STEP (.stp, .step) or BREP (.brep) file: sews, heals and converts
/// to NURBS. A face or edge that cannot be read, healed or converted is lost alone, and listed in
/// CADModel::unread(). Coordinates are the file's own numbers; with a `unit` (m, cm, mm, in or ft,
/// or another name of these) they are converted from the file's unit to that one, parameters are as
/// they were. Files that hold only curves give a model of edges. The file is read by a
/// program of its own, cadrefine-read-cad. Where that dies of what the model can do without (names,
/// sewing, healing, one face), the file is read again without it, which CADReport::repairs tells.
/// Faces and edges are converted on so many threads; the model does not depend on them. Throws
/// Error, which names the file and the reason, where nothing can be read.
std::shared_ptr<const CADModel> readCADFile(
  const std::string& path, const std::string& unit = "", int threads = 1);

/// Reads a file as readCADFile does, and returns the bytes for CADModel::fromBytes, without
/// building the model.
std::vector<char> readCADBytes(
  const std::string& path, const std::string& unit = "", int threads = 1);

/// A stamp of the file that has the name now: when it was last written or put there, to the
/// nanosecond, its size, and which file it is. "none" where there is no such file. Another stamp:
/// another content.
std::string fileStamp(const std::string& path);

/// Sets where cadrefine-read-cad is, unless the environment variable CADREFINE_READER names another
/// place. Returns the path, which must stay valid.
const char* setLinkedReader(const char* path) noexcept;

#ifdef CADREFINE_READER // by CMake's target of this library
inline const char* const linkedReader = setLinkedReader(CADREFINE_READER);
#endif

} // namespace cadrefine
