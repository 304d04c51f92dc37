// 1. Check the parameters of every geometry entity.
// 2. Turn the broken ones into null entities (type 0), and find what refers to them, directly or
//    not.
// 3. Wrap the parameters of entities whose lines run too far anew, at the separators.
// 4. Write a temporary file if anything changed.

#include "IgesRepair.h"

#include "Error.h"
#include "IgesParameterCheck.h"
#include "IgesText.h"
#include "IgesTypes.h"

#include <cstdlib>
#include <filesystem>
#include <unistd.h>

namespace cadrefine
{
namespace
{

std::string temporaryFile()
{
  constexpr int suffixLength = 4;
  std::string name = (std::filesystem::temp_directory_path() / "cadrefine-XXXXXX.igs").string();
  const int descriptor = mkstemps(name.data(), suffixLength);
  if (descriptor < 0)
  {
    throw Error(
      "cannot make a temporary file in " + std::filesystem::temp_directory_path().string());
  }
  close(descriptor);
  return name;
}

std::vector<std::string> wrap(const IgesParameters& parameters, const IgesText& text)
{
  constexpr std::size_t width = 64;
  std::vector<std::string> lines(1);
  for (std::size_t i = 0; i < parameters.values.size(); ++i)
  {
    const bool last = i + 1 == parameters.values.size();
    std::string piece = parameters.values[i] + (last ? text.terminator : text.separator);
    if (lines.back().size() + piece.size() > width && piece.size() <= width)
    {
      lines.emplace_back();
    }
    while (!piece.empty())
    {
      if (lines.back().size() == width)
      {
        lines.emplace_back();
      }
      const std::size_t room = width - lines.back().size();
      lines.back() += piece.substr(0, room);
      piece.erase(0, room);
    }
  }
  return lines;
}

/// Types whose parameters are, or hold, directory entry numbers.
bool hasPointers(int type)
{
  switch (type)
  {
    case 102:
    case 118:
    case 120:
    case 122:
    case 130:
    case 140:
    case 141:
    case 142:
    case 143:
    case 144:
    case 180:
    case 184:
    case 186:
    case 308:
    case 402:
    case 408:
    case 430:
      return true;
    default:
      return type >= 502 && type <= 514;
  }
}

std::set<int> findDependents(
  const IgesText& text, const std::vector<IgesParameters>& parameters, const std::set<int>& broken)
{
  std::set<int> reached = broken;
  for (bool grows = !broken.empty(); grows;)
  {
    grows = false;
    for (std::size_t i = 0; i < text.entries.size(); ++i)
    {
      const IgesEntry& entry = text.entries[i];
      if (!hasPointers(entry.type) || reached.count(entry.number) > 0)
      {
        continue;
      }
      for (std::size_t k = 1; k < parameters[i].values.size(); ++k)
      {
        const int target = std::abs(std::atoi(parameters[i].values[k].c_str()));
        if (reached.count(target) > 0)
        {
          reached.insert(entry.number);
          grows = true;
          break;
        }
      }
    }
  }
  for (const int number : broken)
  {
    reached.erase(number);
  }
  return reached;
}

} // namespace

RepairedIges::RepairedIges(const std::string& path) : path_(path)
{
  IgesText text = readIgesText(path);
  std::vector<IgesParameters> parameters;
  std::set<int> broken;
  int overruns = 0;
  for (IgesEntry& entry : text.entries)
  {
    parameters.push_back(parametersOf(entry, text));
    this->holdsSurfaces_ = this->holdsSurfaces_ || isIgesSurface(entry.type);
    const std::string reason = checkIgesParameters(entry.type, parameters.back());
    if (!reason.empty())
    {
      this->unread_.push_back({ entry.number, igesTypeName(entry.type), reason });
      broken.insert(entry.number);
    }
    else if (entry.overrun)
    {
      ++overruns;
      entry.data = wrap(parameters.back(), text);
    }
  }
  this->dependents_ = findDependents(text, parameters, broken);
  if (overruns > 0)
  {
    this->unread_.push_back({ 0, "IGES",
      "repaired: the parameter lines of " + std::to_string(overruns) +
        " entities run one column too far" });
  }
  if (this->unread_.empty())
  {
    return;
  }
  for (IgesEntry& entry : text.entries)
  {
    if (broken.count(entry.number) > 0)
    {
      entry.type = 0;
      entry.data = { std::string("0") + text.terminator };
    }
  }
  this->path_ = temporaryFile();
  this->temporary_ = true;
  writeIgesText(text, this->path_);
}

RepairedIges::~RepairedIges()
{
  if (this->temporary_)
  {
    std::error_code ignored;
    std::filesystem::remove(this->path_, ignored);
  }
}

} // namespace cadrefine
