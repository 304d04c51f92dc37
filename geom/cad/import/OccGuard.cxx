#include <cadrefine/cad/import/OccGuard.h>

#include <sstream>

namespace cadrefine
{

std::string oneLine(const std::string& text)
{
  std::istringstream words(text);
  std::string line;
  for (std::string word; words >> word;)
  {
    line += (line.empty() ? "" : " ") + word;
  }
  return line;
}

std::string describe(const Standard_Failure& failure)
{
  const char* const message = failure.GetMessageString();
  const std::string text = oneLine(message ? message : "");
  const std::string type = failure.DynamicType()->Name();
  return "Open CASCADE failed (" + type + (text.empty() ? "" : ": " + text) + ")";
}

} // namespace cadrefine
