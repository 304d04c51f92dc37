// Work that may crash or never end, in a process of its own. Private to geom/cad.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace cadrefine
{

/// What `work` returns, done in a child process that shares nothing with this one and prints
/// nothing. An Error of the child is thrown here; a crash, or more than `cpuSeconds` of computing,
/// is an Error that begins with `context`.
std::vector<char> runIsolated(
  const std::string& context, int cpuSeconds, const std::function<std::vector<char>()>& work);

} // namespace cadrefine
