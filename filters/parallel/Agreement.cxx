#include "Agreement.h"

#include <new>

namespace cadrefine
{

std::string reasonOf(const std::exception& error)
{
  if (dynamic_cast<const std::bad_alloc*>(&error))
  {
    return "there is not enough memory";
  }
  const std::string text = error.what();
  return text.empty() ? "unknown failure" : text;
}

} // namespace cadrefine
