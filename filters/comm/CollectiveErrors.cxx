#include "comm/CollectiveErrors.h"

#include <vtkMultiProcessController.h>
#include <vtkObject.h>

#include <cxxabi.h>

#include <cstdlib>
#include <exception>
#include <new>

namespace cadrefine
{
namespace
{

/// The type of the exception that is being handled, as it is written in a program.
std::string caughtType()
{
  int status = 0;
  const char* const mangled = abi::__cxa_current_exception_type()->name();
  char* const name = abi::__cxa_demangle(mangled, nullptr, nullptr, &status);
  std::string type = name ? name : mangled;
  std::free(name);
  return type;
}

} // namespace

// Exceptions of Open CASCADE before 7.9 are no std::exception.
std::string caughtReason()
{
  try
  {
    throw;
  }
  catch (const std::bad_alloc&)
  {
    return "there is not enough memory";
  }
  catch (const std::exception& error)
  {
    const std::string text = error.what();
    return text.empty() ? "unknown failure" : text;
  }
  catch (...)
  {
    return "unknown failure (" + caughtType() + ")";
  }
}

void reportOnce(vtkObject* object, vtkMultiProcessController* controller)
{
  if (!controller || controller->GetLocalProcessId() == 0)
  {
    vtkErrorWithObjectMacro(object, << caughtReason());
  }
}

} // namespace cadrefine
