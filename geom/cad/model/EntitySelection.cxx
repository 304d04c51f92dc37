#include <cadrefine/cad/model/EntitySelection.h>

#include <cadrefine/base/Error.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <set>

#include <fnmatch.h>

namespace cadrefine
{
namespace
{

/// An entry as it is written.
struct Entry
{
  std::string name;
  bool excluded = false;
  std::optional<double> tolerance;
};

Entry parse(const std::string& text, const std::string& property)
{
  Entry entry;
  entry.excluded = text.rfind('!', 0) == 0;
  entry.name = text.substr(entry.excluded ? 1 : 0);
  const std::size_t sign = entry.name.rfind('=');
  if (sign != std::string::npos)
  {
    const std::string number = entry.name.substr(sign + 1);
    char* end = nullptr;
    entry.tolerance = std::strtod(number.c_str(), &end);
    if (number.empty() || *end != '\0' || !std::isfinite(*entry.tolerance) ||
        *entry.tolerance <= 0 || entry.excluded)
    {
      throw Error(property + ": \"" + text +
                  "\": \"=\" must be followed by a chord tolerance, a length above 0, as in \"" +
                  entry.name.substr(0, sign) + "=0.01\"");
    }
    entry.name.resize(sign);
  }
  return entry;
}

std::string nounOf(int dimension)
{
  return dimension == 2 ? "face" : "edge";
}

/// What entities there are, as text for a message.
std::string describeAll(const CADModel& model, int dimension)
{
  constexpr std::size_t most = 20;
  const int count = model.count(dimension);
  std::set<std::string> names;
  for (int index = 0; index < count; ++index)
  {
    names.insert(model.attributes({ static_cast<std::int8_t>(dimension), index }).name);
  }
  names.erase("");
  std::string text = "it has " + std::to_string(count) + " " + nounOf(dimension) + "s";
  text += count > 0 ? ", numbers 0 to " + std::to_string(count - 1) : "";
  text += names.empty() ? ", and no names" : ", and the names ";
  std::size_t listed = 0;
  for (const std::string& name : names)
  {
    if (listed == most)
    {
      return text + ", ...";
    }
    text += (listed++ > 0 ? ", " : "") + name;
  }
  return text;
}

/// Indices of those that an entry names.
std::vector<int> findEntities(const CADModel& model, int dimension, const std::string& name)
{
  std::vector<int> exact;
  std::vector<int> alike;
  const int count = model.count(dimension);
  for (int index = 0; index < count; ++index)
  {
    const std::string& its = model.attributes({ static_cast<std::int8_t>(dimension), index }).name;
    if (its == name && !name.empty())
    {
      exact.push_back(index);
    }
    else if ((!its.empty() || name == "*") && fnmatch(name.c_str(), its.c_str(), 0) == 0)
    {
      alike.push_back(index);
    }
  }
  const bool isNumber = !name.empty() && name.size() < 10 &&
                        std::all_of(name.begin(), name.end(),
                          [](unsigned char digit) { return digit >= '0' && digit <= '9'; });
  if (exact.empty() && alike.empty() && isNumber && std::stoi(name) < count)
  {
    return { std::stoi(name) };
  }
  return exact.empty() ? alike : exact;
}

} // namespace

bool EntitySelection::contains(const NurbsModel& model, EntityId entity) const
{
  const auto isChosen = [&](int index) { return chosen[index] != 0; };
  if (entity.dimension == dimension)
  {
    return isChosen(entity.index);
  }
  if (entity.dimension == 1)
  {
    const auto& faces = model.edges[entity.index].faces;
    return std::any_of(faces.begin(), faces.end(), isChosen);
  }
  if (entity.dimension == 0)
  {
    const auto& edges = model.vertices[entity.index].edges;
    return std::any_of(edges.begin(), edges.end(),
      [&](int edge) {
        return contains(model, { 1, edge });
      });
  }
  return false;
}

bool EntitySelection::hasTolerances() const
{
  return std::any_of(
    chordTolerances.begin(), chordTolerances.end(), [](double value) { return value > 0; });
}

EntitySelection selectEntities(const CADModel& model, int dimension,
  const std::vector<std::string>& wanted, const std::string& property)
{
  EntitySelection selection;
  selection.dimension = dimension;
  const bool takesAway = !wanted.empty() && wanted.front().rfind('!', 0) == 0;
  selection.chosen.assign(model.count(dimension), wanted.empty() || takesAway);
  selection.chordTolerances.assign(model.count(dimension), 0);
  for (const std::string& text : wanted)
  {
    const Entry entry = parse(text, property);
    const std::vector<int> found = findEntities(model, dimension, entry.name);
    if (found.empty())
    {
      throw Error(property + ": the CAD has no " + nounOf(dimension) + " \"" + entry.name + "\"; " +
                  describeAll(model, dimension));
    }
    for (const int index : found)
    {
      selection.chosen[index] = !entry.excluded;
      selection.chordTolerances[index] = entry.tolerance.value_or(selection.chordTolerances[index]);
    }
  }
  return selection;
}

std::string entryOf(const CADModel& model, EntityId entity)
{
  const std::string& name = model.attributes(entity).name;
  const bool isPlain = name.find_first_of("*?[]\\=") == std::string::npos && name[0] != '!';
  const bool isItsOwn = !name.empty() && findEntities(model, entity.dimension, name).size() == 1;
  return isPlain && isItsOwn ? name : std::to_string(entity.index);
}

} // namespace cadrefine
