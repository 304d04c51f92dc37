// Where the program is that reads CAD files, cadrefine-read-cad. Private to geom/cad.
#pragma once

#include <string>

namespace cadrefine
{

/// 1. What the environment variable CADREFINE_READER says.
/// 2. In a program that links this library: what CMake's target says (linkedReader in CADFile.h).
/// 3. In the library of filters, which can be moved with the program: the place beside it.
std::string readerPath();

} // namespace cadrefine
