// 1. Check the parameters of every geometry entity.
// 2. Wrap the parameters anew, at the separators, of entities whose lines run too far or have no
//    end.
// 3. Find what is made of broken entities, directly or not.
// 4. Write a temporary file, with null entities (type 0) in place of the broken ones, if anything
//    is wrong.

#include "IgesRepair.h"

#include "Error.h"
#include "IgesParameterCheck.h"
#include "IgesPointers.h"
#include "IgesTypes.h"

#include <algorithm>
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

/// Parameters without a terminator are whole where as many are there as the type needs, and the
/// file goes on after them.
bool isWhole(const IgesEntry& entry, const IgesParameters& parameters, const IgesText& text)
{
  const std::size_t needed = igesParameterCount(entry, parameters);
  const bool goesOn = text.complete || entry.number != text.entries.back().number;
  return goesOn && needed > 0 && parameters.values.size() >= needed;
}

/// Entities that are made of one of `broken`, directly or not, and are not broken themselves.
std::set<int> findDependents(const std::vector<IgesEntry>& entries,
  const std::vector<std::vector<int>>& parts, const std::set<int>& broken)
{
  std::set<int> reached = broken;
  for (bool grows = !broken.empty(); grows;)
  {
    grows = false;
    for (std::size_t i = 0; i < entries.size(); ++i)
    {
      const bool depends = std::any_of(
        parts[i].begin(), parts[i].end(), [&](int part) { return reached.count(part) > 0; });
      grows = (depends && reached.insert(entries[i].number).second) || grows;
    }
  }
  for (const int number : broken)
  {
    reached.erase(number);
  }
  return reached;
}

/// Entities with a broken transformation, or with one that has one.
std::set<int> findMisplaced(const std::vector<IgesEntry>& entries, const std::set<int>& broken)
{
  std::set<int> misplaced;
  for (bool grows = true; grows;)
  {
    grows = false;
    for (const IgesEntry& entry : entries)
    {
      const bool isOff = broken.count(entry.matrix) > 0 || misplaced.count(entry.matrix) > 0;
      grows = (isOff && misplaced.insert(entry.number).second) || grows;
    }
  }
  return misplaced;
}

void note(std::vector<std::string>& faults, int count, const std::string& what)
{
  if (count > 0)
  {
    faults.push_back("the parameters of " + std::to_string(count) + " entities " + what);
  }
}

} // namespace

RepairedIges::RepairedIges(const std::string& path) : text_(readIgesText(path)), path_(path)
{
  checkEntries();
  const std::set<int> misplaced = findMisplaced(text_.entries, broken_);
  broken_.insert(misplaced.begin(), misplaced.end());
  dependents_ = findDependents(text_.entries, parts_, broken_);
  if (!unread_.empty() || !text_.faults.empty())
  {
    write();
  }
}

void RepairedIges::checkEntries()
{
  int overruns = 0;
  int unterminated = 0;
  for (IgesEntry& entry : text_.entries)
  {
    const IgesParameters parameters = parametersOf(entry, text_);
    parts_.push_back(igesParts(entry, parameters));
    if (entry.matrix > 0)
    {
      parts_.back().push_back(entry.matrix);
    }
    std::string reason = checkIgesParameters(entry.type, parameters);
    if (reason.empty() && isIgesPartOfModel(entry.type) && !parameters.terminated &&
        !isWhole(entry, parameters, text_))
    {
      reason = "its parameters have no end";
    }
    if (!reason.empty())
    {
      unread_.push_back({ entry.number, igesTypeName(entry.type), reason });
      broken_.insert(entry.number);
      continue;
    }
    overruns += entry.overrun ? 1 : 0;
    unterminated += parameters.terminated ? 0 : 1;
    if (entry.overrun || !parameters.terminated)
    {
      entry.data = wrapParameters(parameters, text_);
    }
  }
  note(text_.faults, overruns, "run one column too far");
  note(text_.faults, unterminated, "have no terminator");
}

void RepairedIges::write()
{
  IgesText repaired = text_;
  for (IgesEntry& entry : repaired.entries)
  {
    if (isBroken(entry.number))
    {
      entry.type = 0;
      entry.data = { std::string("0") + repaired.terminator };
    }
  }
  path_ = temporaryFile();
  temporary_ = true;
  writeIgesText(repaired, path_);
}

RepairedIges::~RepairedIges()
{
  if (temporary_)
  {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
}

} // namespace cadrefine
