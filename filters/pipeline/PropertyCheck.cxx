#include "pipeline/PropertyCheck.h"

#include <cadrefine/base/Error.h>

#include <cmath>
#include <sstream>
#include <string>

namespace cadrefine
{
namespace
{

std::string rangeOf(double lowest, double highest)
{
  std::ostringstream text;
  text << "a finite number";
  if (std::isfinite(lowest))
  {
    text << (std::isfinite(highest) ? " from " : " of ") << lowest;
    std::isfinite(highest) ? text << " to " << highest : text << " or more";
  }
  return text.str();
}

} // namespace

void checkProperty(const char* name, double value, double lowest, double highest)
{
  if (!std::isfinite(value) || value < lowest || value > highest)
  {
    std::ostringstream reason;
    reason << "the property " << name << " is " << value << ", which is not "
           << rangeOf(lowest, highest);
    throw Error(reason.str());
  }
}

void checkBox(const char* name, const double* bounds)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const double* ends = bounds + 2 * axis;
    checkProperty(name, ends[0]);
    checkProperty(name, ends[1]);
    if (ends[0] > ends[1])
    {
      std::ostringstream reason;
      reason << "the region is empty (" << name << "): its lower bound in "
             << "xyz"[axis] << ", " << ends[0] << ", is above its upper one, " << ends[1];
      throw Error(reason.str());
    }
  }
}

} // namespace cadrefine
