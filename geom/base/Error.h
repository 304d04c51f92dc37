// The one exception of the numerical core.
#pragma once

#include <stdexcept>
#include <string>

namespace cadrefine
{

/// A bad model or bad input. The text names the file, array or property and the reason, and is
/// shown to the user as it is. A point or cell that fails is data (a status), never an Error.
class Error : public std::runtime_error
{
public:
  explicit Error(const std::string& reason) : std::runtime_error(reason) {}
};

} // namespace cadrefine
