// The border to Open CASCADE: its exceptions become errors of our own. Private to geom/cad.
#pragma once

#include <cadrefine/base/Error.h>

#include <Standard_Failure.hxx>

#include <string>

namespace cadrefine
{

/// One line that tells what `failure` says.
std::string describe(const Standard_Failure& failure);

/// `text` on one line, without leading or trailing blanks.
std::string oneLine(const std::string& text);

/// Runs `work`; an exception of Open CASCADE leaves as an Error that begins with `context`.
/// (Standard_Failure is no std::exception before Open CASCADE 7.9, so it must not get out.)
template<typename Work>
auto guardOcc(const std::string& context, const Work& work) -> decltype(work())
{
  try
  {
    return work();
  }
  catch (const Standard_Failure& failure)
  {
    throw Error(context + ": " + describe(failure));
  }
}

} // namespace cadrefine
