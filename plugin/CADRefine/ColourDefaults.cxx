#include "ColourDefaults.h"

#include <vtkMath.h>
#include <vtkSMSettings.h>

#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace
{

using Colour = std::array<double, 3>;

struct Category
{
  std::string value;
  std::string label;
  Colour colour;
};

constexpr Colour Grey{ 0.8, 0.8, 0.8 };
constexpr Colour Blue{ 0.30, 0.53, 0.76 };
constexpr Colour Red{ 0.84, 0.15, 0.16 };
constexpr Colour Orange{ 0.95, 0.60, 0.15 };

/// Entities beyond these are drawn in the colour of "not on the CAD"; ParaView keeps the whole list
/// in each state file.
constexpr int EntityCount = 256;

/// The colour of an entity: hues a golden section apart, so that neighbours in the list differ.
Colour EntityColour(int entity)
{
  constexpr double golden = 0.6180339887498949;
  const double hue = std::fmod(0.58 + golden * entity, 1.0);
  const std::array<double, 3> saturations{ 0.45, 0.65, 0.35 };
  const std::array<double, 2> values{ 0.92, 0.78 };
  Colour colour;
  vtkMath::HSVToRGB(
    hue, saturations[entity % 3], values[entity % 2], &colour[0], &colour[1], &colour[2]);
  return colour;
}

std::vector<Category> Entities()
{
  std::vector<Category> categories;
  for (int entity = 0; entity < EntityCount; ++entity)
  {
    const std::string name = std::to_string(entity);
    categories.push_back({ name, name, EntityColour(entity) });
  }
  return categories;
}

std::string Numbers(const Colour& colour)
{
  std::ostringstream text;
  text << colour[0] << ", " << colour[1] << ", " << colour[2];
  return text.str();
}

/// The look-up table of an array, as JSON.
std::string Table(const std::string& array, const std::string& properties)
{
  return "\"" + array + "\": { \"PVLookupTable\": { " + properties + " } }";
}

std::string Categorical(const std::string& array, const std::vector<Category>& categories)
{
  std::string labels;
  std::string colours;
  const char* separator = "";
  for (const Category& category : categories)
  {
    labels += separator + ("\"" + category.value + "\", \"" + category.label + "\"");
    colours += separator + Numbers(category.colour);
    separator = ", ";
  }
  return Table(array, "\"IndexedLookup\": 1, \"AnnotationsInitialized\": 1, "
                      "\"NanColor\": [" +
                        Numbers(Grey) + "], \"Annotations\": [" + labels +
                        "], \"IndexedColors\": [" + colours + "]");
}

std::string Settings()
{
  const std::vector<std::string> measures{ "GeometricError", "GeometricDistance", "ChordError",
    "CADDistance" };
  std::string presets = "\"CellQuality\": \"Viridis (matplotlib)\"";
  for (const std::string& array : measures)
  {
    presets += ", \"" + array + "\": \"Plasma (matplotlib)\"";
  }
  const std::string tables =
    Categorical("CADEntity", Entities()) + ", " +
    Categorical("CADDimension", { { "-1", "not on the CAD", Grey }, { "0", "vertex", Red },
                                  { "1", "edge", Orange }, { "2", "face", Blue } }) +
    ", " + Categorical("CADConflict", { { "0", "no conflict", Grey }, { "1", "conflict", Red } }) +
    ", " + Categorical("CellValidity", { { "0", "invalid", Red }, { "1", "valid", Blue } });
  return "{ \"standard_presets\": { " + presets + " }, \"array_lookup_tables\": { " + tables +
         " } }";
}

} // namespace

void addColourDefaults()
{
  constexpr double belowSiteAndUser = 0; // ParaView gives 1 to the site's settings
  vtkSMSettings::GetInstance()->AddCollectionFromString(Settings(), belowSiteAndUser);
}
