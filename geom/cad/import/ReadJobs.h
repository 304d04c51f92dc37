// What the program cadrefine-read-cad does. Private to geom/cad.
#pragma once

#include <cadrefine/cad/import/IsolatedRun.h>

namespace cadrefine
{

std::vector<char> readJob(const std::string& path, ByteReader& input); ///< The job of readCADBytes.
std::vector<char> drawJob(const std::string& context, ByteReader& input); ///< The job of drawModel.

inline RunJobs readJobs()
{
  return { { "read", readJob }, { "draw", drawJob } };
}

} // namespace cadrefine
