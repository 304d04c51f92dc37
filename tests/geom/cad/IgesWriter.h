// Writes IGES 5.3 files entity by entity, so that tests can say all that the format can.
#pragma once

#include <string>
#include <type_traits>
#include <vector>

namespace cadtest
{

/// Parameters of an entity as they stand in the file.
using IgesValues = std::vector<std::string>;

std::string igesValue(int value);
std::string igesValue(double value);
/// A string constant, "5HHello".
std::string igesValue(const std::string& text);

inline void appendTo(IgesValues&) {}

inline std::string igesValue(const char* text)
{
  return igesValue(std::string(text));
}

template<typename First, typename... Rest>
void appendTo(IgesValues& values, const First& first, const Rest&... rest)
{
  if constexpr (std::is_arithmetic_v<First> || std::is_convertible_v<First, std::string>)
  {
    values.push_back(igesValue(first));
  }
  else
  {
    for (const auto& item : first)
    {
      appendTo(values, item);
    }
  }
  appendTo(values, rest...);
}

/// Numbers, texts and ranges of them, in order.
template<typename... Items>
IgesValues igesValues(const Items&... items)
{
  IgesValues values;
  appendTo(values, items...);
  return values;
}

enum class IgesUse
{
  Geometry = 0,
  Annotation = 1,
  Definition = 2,
  Other = 3,
  Logical = 4,
  Parametric = 5,
  Construction = 6
};

/// What the directory says of an entity beside its type.
struct IgesAttributes
{
  int form = 0;
  int transformation = 0; ///< Directory entry of a matrix (124).
  bool blanked = false;
  int subordinate = 0; ///< 1 physically, 2 logically, 3 both.
  IgesUse use = IgesUse::Geometry;
  int colour = 0; ///< Number of a colour, or minus the directory entry of one (314).
  std::string label;
  std::vector<int> properties; ///< Directory entries, for example of a name (406).
};

class IgesWriter
{
public:
  /// Adds an entity; its directory entry number.
  int add(int type, const IgesValues& parameters, const IgesAttributes& attributes = {});
  /// As `unitFlag` and `unitName` of the global section. Default: millimetres.
  void setUnit(int flag, const std::string& name);
  /// The lines of the file, 80 columns each.
  std::vector<std::string> lines() const;
  void write(const std::string& path) const;

private:
  struct Entity
  {
    int type = 0;
    IgesAttributes attributes;
    IgesValues parameters;
  };
  std::vector<std::string> globalLines() const;

  std::vector<Entity> entities_;
  int unitFlag_ = 2;
  std::string unitName_ = "MM";
};

} // namespace cadtest
