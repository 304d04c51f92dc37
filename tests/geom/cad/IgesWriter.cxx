#include "IgesWriter.h"

#include "TestFiles.h"

#include <algorithm>
#include <cstdio>

namespace cadtest
{
namespace
{

constexpr std::size_t dataColumns = 64;
constexpr std::size_t lineColumns = 72;

/// Values with separators, cut into lines between values where they fit; longer values run on.
std::vector<std::string> wrap(const IgesValues& values, std::size_t width)
{
  std::vector<std::string> lines(1);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    const std::string value = values[i] + (i + 1 < values.size() ? "," : ";");
    if (lines.back().size() + value.size() > width && value.size() <= width)
    {
      lines.emplace_back();
    }
    lines.back() += value;
    while (lines.back().size() > width)
    {
      const std::string rest = lines.back().substr(width);
      lines.back().resize(width);
      lines.push_back(rest);
    }
  }
  return lines;
}

template<typename... Values>
std::string print(const char* format, Values... values)
{
  char text[128];
  std::snprintf(text, sizeof(text), format, values...);
  return text;
}

std::string record(std::string data, char section, std::size_t number)
{
  data.resize(lineColumns, ' ');
  return data + print("%c%7d", section, static_cast<int>(number));
}

} // namespace

std::string igesValue(int value)
{
  return std::to_string(value);
}

std::string igesValue(double value)
{
  std::string text = print("%.17G", value);
  if (text.find('.') == std::string::npos)
  {
    text.insert(std::min(text.find('E'), text.size()), ".");
  }
  return text;
}

std::string igesValue(const std::string& text)
{
  return std::to_string(text.size()) + "H" + text;
}

int IgesWriter::add(int type, const IgesValues& parameters, const IgesAttributes& attributes)
{
  entities_.push_back({ type, attributes, parameters });
  return 2 * static_cast<int>(entities_.size()) - 1;
}

void IgesWriter::setUnit(int flag, const std::string& name)
{
  unitFlag_ = flag;
  unitName_ = name;
}

std::vector<std::string> IgesWriter::globalLines() const
{
  const char* const date = "20260101.000000";
  return wrap(
    igesValues(",", ";", "test", "test.igs", "test", "test", 32, 38, 6, 308, 15, "test", 1.0,
      unitFlag_, unitName_, 1, 0.0, date, 1e-9, 100.0, "author", "organisation", 11, 0, date),
    lineColumns);
}

std::vector<std::string> IgesWriter::lines() const
{
  std::vector<std::string> start{ record("written by a test", 'S', 1) };
  std::vector<std::string> global, directory, parameters;
  for (const std::string& line : globalLines())
  {
    global.push_back(record(line, 'G', global.size() + 1));
  }
  for (const Entity& entity : entities_)
  {
    const IgesAttributes& a = entity.attributes;
    const std::size_t number = directory.size() + 1;
    IgesValues values = entity.parameters;
    values.insert(values.begin(), igesValue(entity.type));
    if (!a.properties.empty())
    {
      appendTo(values, 0, static_cast<int>(a.properties.size()), a.properties);
    }
    const auto data = wrap(values, dataColumns);
    const int first = static_cast<int>(parameters.size()) + 1;
    directory.push_back(
      record(print("%8d%8d%8d%8d%8d%8d%8d%8d%02d%02d%02d00", entity.type, first, 0, 0, 0, 0,
               a.transformation, 0, a.blanked ? 1 : 0, a.subordinate, static_cast<int>(a.use)),
        'D', number));
    directory.push_back(record(print("%8d%8d%8d%8d%8d%16s%8s%8d", entity.type, 0, a.colour,
                                 static_cast<int>(data.size()), a.form, "", a.label.c_str(), 0),
      'D', number + 1));
    for (const std::string& line : data)
    {
      parameters.push_back(record(
        line + std::string(dataColumns - line.size(), ' ') + print("%8d", static_cast<int>(number)),
        'P', parameters.size() + 1));
    }
  }
  const std::string end = print("S%7dG%7dD%7dP%7d", 1, static_cast<int>(global.size()),
    static_cast<int>(directory.size()), static_cast<int>(parameters.size()));
  std::vector<std::string> all = start;
  for (const auto* section : { &global, &directory, &parameters })
  {
    all.insert(all.end(), section->begin(), section->end());
  }
  all.push_back(record(end, 'T', 1));
  return all;
}

void IgesWriter::write(const std::string& path) const
{
  writeLines(path, lines());
}

} // namespace cadtest
