// Mesh files of other programs than ParaView, read and written by the driver's Python package,
// which lies in the folder cadrefine/python beside the library. Nothing here communicates.
#pragma once

#include <string>

class vtkUnstructuredGrid;

namespace cadrefine
{

/// Whether the file is of a format that the package reads, by its ending and, where other programs
/// use the same ending, by its beginning. True where there is no Python to ask: reading then says
/// so.
bool canReadMeshFile(const std::string& path);

/// Reads a file into `grid`. Throws Error, with a line that names the file and the reason.
void readMeshFile(const std::string& path, vtkUnstructuredGrid* grid);

/// Writes a file, whole or not at all: what was there stays until the new file is complete. For a
/// .msh file, `version` is "2.2" or "4.1", and `ascii` chooses text. Throws Error, as above.
void writeMeshFile(
  vtkUnstructuredGrid* grid, const std::string& path, const std::string& version, bool ascii);

} // namespace cadrefine
