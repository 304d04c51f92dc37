// 1. Check the parameters of every geometry entity.
// 2. Wrap the parameters anew, at the separators, of entities whose lines run too far or have no
//    end.
// 3. Find what is made of itself, and what is made of broken entities, directly or not.
// 4. Write a temporary file, with null entities (type 0) in place of the broken ones, if anything
//    is wrong.

#include <cadrefine/cad/readers/iges/IgesRepair.h>

#include <cadrefine/base/Error.h>
#include <cadrefine/cad/readers/iges/IgesParameterCheck.h>
#include <cadrefine/cad/readers/iges/IgesPointers.h>
#include <cadrefine/cad/readers/iges/IgesTypes.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <iterator>
#include <unistd.h>

namespace cadrefine
{
namespace
{

constexpr int solidType = 186;
constexpr int shellType = 514;

/// A file without a name, so that none is left behind wherever the process may die; its descriptor.
int temporaryFile()
{
  const std::string folder = std::filesystem::temp_directory_path().string();
  std::string name = folder + "/cadrefine-XXXXXX";
  const int descriptor = mkostemp(name.data(), O_CLOEXEC);
  if (descriptor < 0)
  {
    throw Error("cannot make a temporary file in " + folder + ": " + std::strerror(errno));
  }
  unlink(name.c_str());
  return descriptor;
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

/// Indices of the entities that `parts`, turned round where `backwards`, lead back to, or through.
/// Entities without parts are taken away until there are none (Kahn, "Topological sorting of large
/// networks", 1962). Work and memory: linear.
std::set<std::size_t> findUnsorted(const std::vector<std::vector<int>>& parts, bool backwards)
{
  std::vector<std::vector<std::size_t>> users(parts.size());
  std::vector<std::size_t> open(parts.size(), 0);
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    for (const int part : parts[i])
    {
      const std::size_t other = static_cast<std::size_t>(part) / 2;
      if (part % 2 == 1 && other < parts.size())
      {
        users[backwards ? i : other].push_back(backwards ? other : i);
        ++open[backwards ? other : i];
      }
    }
  }
  std::vector<std::size_t> ready;
  std::set<std::size_t> left;
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    left.insert(left.end(), i);
    if (open[i] == 0)
    {
      ready.push_back(i);
    }
  }
  while (!ready.empty())
  {
    const std::size_t i = ready.back();
    ready.pop_back();
    left.erase(i);
    for (const std::size_t user : users[i])
    {
      if (--open[user] == 0)
      {
        ready.push_back(user);
      }
    }
  }
  return left;
}

/// Indices of the entities that are made of themselves, directly or through others.
std::vector<std::size_t> findCircles(const std::vector<std::vector<int>>& parts)
{
  const std::set<std::size_t> above = findUnsorted(parts, false);
  const std::set<std::size_t> below = findUnsorted(parts, true);
  std::vector<std::size_t> circles;
  std::set_intersection(
    above.begin(), above.end(), below.begin(), below.end(), std::back_inserter(circles));
  return circles;
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
  checkReferences();
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
      setAside(entry, reason);
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

void RepairedIges::setAside(const IgesEntry& entry, const std::string& reason)
{
  if (broken_.insert(entry.number).second)
  {
    unread_.push_back({ entry.number, igesTypeName(entry.type), reason });
  }
}

/// Open CASCADE follows circles until its stack is full.
void RepairedIges::checkReferences()
{
  for (const std::size_t i : findCircles(parts_))
  {
    setAside(text_.entries[i], "contains itself");
  }
  for (std::size_t i = 0; i < parts_.size(); ++i)
  {
    const IgesEntry& entry = text_.entries[i];
    const auto isShell = [&](int part)
    {
      const std::size_t index = static_cast<std::size_t>(part) / 2;
      return part == entry.matrix ||
             (index < text_.entries.size() && text_.entries[index].type == shellType);
    };
    if (entry.type == solidType && !std::all_of(parts_[i].begin(), parts_[i].end(), isShell))
    {
      setAside(entry, "contains something that is not a shell");
    }
  }
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
  temporary_ = temporaryFile();
  path_ = "/proc/self/fd/" + std::to_string(temporary_);
  writeIgesText(repaired, path_);
}

RepairedIges::~RepairedIges()
{
  if (temporary_ >= 0)
  {
    close(temporary_);
  }
}

} // namespace cadrefine
