// Has a file changed?
#pragma once

#include <string>

namespace cadrefine
{

/// Of the file that has the name now: when it was last written or put there, to the nanosecond, its
/// size, and which file it is. "none" where there is no such file. Another stamp: another content.
std::string fileStamp(const std::string& path);

} // namespace cadrefine
