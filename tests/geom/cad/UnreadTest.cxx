// Broken entities are listed by number, type and reason, and the rest of the file is read.

#include "TestFiles.h"

#include <cadrefine/cad/import/CADFile.h>

#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepPrimAPI_MakeBox.hxx>

#include <gtest/gtest.h>

#include <algorithm>

namespace
{

constexpr std::size_t dataColumns = 64;

bool isParameterLine(const std::string& line)
{
  return line.size() > 72 && line[72] == 'P';
}

int directoryEntryOf(const std::string& line)
{
  return std::stoi(line.substr(dataColumns, 8));
}

/// Line numbers of the parameter lines that begin an entity of `type`.
std::vector<std::size_t> entitiesOf(const std::vector<std::string>& lines, const std::string& type)
{
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < lines.size(); ++i)
  {
    if (isParameterLine(lines[i]) && lines[i].compare(0, type.size() + 1, type + ",") == 0)
    {
      found.push_back(i);
    }
  }
  return found;
}

/// Puts a word where a number belongs.
void spoil(std::string& line)
{
  const std::size_t comma = line.find(',');
  line.replace(comma + 1, 1, "X");
}

class Unread : public testing::Test
{
protected:
  void SetUp() override
  {
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 2, 3).Shape();
    cadtest::writeShape(BRepBuilderAPI_NurbsConvert(box).Shape(), this->path);
    this->lines = cadtest::linesOf(this->path);
  }

  cadtest::TemporaryFolder folder;
  std::string path = folder.file("box.igs");
  std::vector<std::string> lines;
};

TEST_F(Unread, anIntactFileHasNone)
{
  const auto model = cadrefine::readCADFile(this->path);
  EXPECT_EQ(model->count(2), 6);
  EXPECT_TRUE(model->unread().empty());
}

TEST_F(Unread, aBrokenSurfaceIsListed)
{
  const auto surfaces = entitiesOf(this->lines, "128");
  ASSERT_EQ(surfaces.size(), 6u);
  std::string& line = this->lines[surfaces[2]];
  spoil(line);
  cadtest::writeLines(this->path, this->lines);
  const auto model = cadrefine::readCADFile(this->path);
  EXPECT_EQ(model->count(2), 5);
  ASSERT_EQ(model->unread().size(), 1u);
  EXPECT_EQ(model->unread()[0].entity, directoryEntryOf(line));
  EXPECT_EQ(model->unread()[0].type, "IGES 128 (rational B-spline surface)");
  EXPECT_NE(model->unread()[0].reason, "");
  EXPECT_EQ(model->unread()[0].reason.find('\n'), std::string::npos);
}

TEST_F(Unread, aBrokenFaceIsListed)
{
  const auto faces = entitiesOf(this->lines, "144");
  ASSERT_EQ(faces.size(), 6u);
  spoil(this->lines[faces[0]]);
  cadtest::writeLines(this->path, this->lines);
  const auto model = cadrefine::readCADFile(this->path);
  EXPECT_EQ(model->count(2), 5);
  ASSERT_EQ(model->unread().size(), 1u);
  EXPECT_EQ(model->unread()[0].entity, directoryEntryOf(this->lines[faces[0]]));
  EXPECT_EQ(model->unread()[0].type, "IGES 144 (trimmed surface)");
}

TEST_F(Unread, aFileWithNothingLeftIsAnErrorThatNamesTheEntities)
{
  const auto surfaces = entitiesOf(this->lines, "128");
  for (const std::size_t i : surfaces)
  {
    spoil(this->lines[i]);
  }
  cadtest::writeLines(this->path, this->lines);
  const std::string error = cadtest::errorOfReading(this->path);
  EXPECT_NE(error.find(this->path), std::string::npos) << error;
  const std::string entity = std::to_string(directoryEntryOf(this->lines[surfaces[0]]));
  EXPECT_NE(error.find(entity + " IGES 128"), std::string::npos) << error;
}

TEST_F(Unread, everyKindOfBrokenSplineIsFoundBeforeItDoesHarm)
{
  // Parameters of a bilinear surface: type, K1, K2, M1, M2, five flags, 4 + 4 knots, 4 weights, ...
  const auto withParameter = [this](std::size_t at, const std::string& value)
  {
    std::vector<std::string> broken = this->lines;
    std::string& line = broken[entitiesOf(broken, "128")[0]];
    std::size_t from = 0;
    for (std::size_t k = 0; k < at; ++k)
    {
      from = line.find(',', from) + 1;
    }
    std::string data = line.substr(0, dataColumns);
    data.replace(from, data.find(',', from) - from, value);
    data.resize(dataColumns, ' ');
    line = data + line.substr(dataColumns);
    cadtest::writeLines(this->path, broken);
    const auto model = cadrefine::readCADFile(this->path);
    EXPECT_EQ(model->count(2), 5) << at << " " << value;
    return model->unread().size() == 1 ? model->unread()[0].reason : "";
  };
  EXPECT_NE(withParameter(1, "7").find("needs"), std::string::npos);
  EXPECT_NE(withParameter(1, "-1").find("control points"), std::string::npos);
  EXPECT_NE(withParameter(1, "999999999"), "");
  EXPECT_NE(withParameter(3, "0").find("degree"), std::string::npos);
  EXPECT_NE(withParameter(3, "99").find("degree"), std::string::npos);
  EXPECT_NE(withParameter(10, "1E9").find("knots"), std::string::npos);
  EXPECT_NE(withParameter(0, "126").find("type"), std::string::npos);
}

/// Parameters of each entity in one string, with the field that names its directory entry.
struct Parameters
{
  std::string data;
  std::string entry;
};

std::vector<Parameters> joinParameters(const std::vector<std::string>& lines)
{
  std::vector<Parameters> all;
  for (const std::string& line : lines)
  {
    if (!isParameterLine(line))
    {
      continue;
    }
    const std::string entry = line.substr(dataColumns, 8);
    if (all.empty() || all.back().entry != entry)
    {
      all.push_back({ "", entry });
    }
    const std::string data = line.substr(0, dataColumns);
    all.back().data += data.substr(0, data.find_last_not_of(' ') + 1);
  }
  return all;
}

std::string numberField(const char* format, std::size_t number)
{
  char field[16];
  std::snprintf(field, sizeof(field), format, static_cast<int>(number));
  return field;
}

/// The file with its parameters in 65 columns, as some programs write them: the next field loses
/// its first column, or, shifted, moves on by one.
std::vector<std::string> widen(const std::vector<std::string>& lines, bool shifted)
{
  std::vector<std::string> wide;
  std::vector<std::size_t> counts;
  for (const Parameters& p : joinParameters(lines))
  {
    const std::size_t before = wide.size();
    for (std::size_t at = 0; at < p.data.size(); at += dataColumns + 1)
    {
      std::string line = p.data.substr(at, dataColumns + 1);
      const bool moved = shifted && line.size() > dataColumns;
      line.resize(dataColumns + (moved || !shifted ? 1 : 0), ' ');
      line += shifted ? p.entry : p.entry.substr(1);
      wide.push_back(line + numberField("P%7d", wide.size() + 1));
    }
    counts.push_back(wide.size() - before);
  }
  std::vector<std::string> result;
  std::size_t pointer = 1;
  std::size_t directory = 0;
  for (std::string line : lines)
  {
    if (line[72] == 'D')
    {
      const std::size_t count = counts[directory / 2];
      const bool first = directory++ % 2 == 0;
      line.replace(first ? 8 : 24, 8, numberField("%8d", first ? pointer : count));
      pointer += first ? 0 : count;
    }
    if (line[72] == 'T')
    {
      result.insert(result.end(), wide.begin(), wide.end());
    }
    if (line[72] != 'P')
    {
      result.push_back(line);
    }
  }
  return result;
}

TEST_F(Unread, linesThatRunOneColumnTooFarAreRepaired)
{
  for (const bool shifted : { false, true })
  {
    cadtest::writeLines(this->path, widen(this->lines, shifted));
    const auto model = cadrefine::readCADFile(this->path);
    EXPECT_EQ(model->count(2), 6) << shifted;
    EXPECT_EQ(model->count(0), 8) << shifted;
    EXPECT_TRUE(model->unread().empty()) << shifted;
    const auto& repairs = model->report().repairs;
    EXPECT_TRUE(std::any_of(repairs.begin(), repairs.end(),
      [](const std::string& r) { return r.find("one column too far") != std::string::npos; }));
  }
}

TEST(UnreadStep, aBrokenFaceIsListedByItsNumber)
{
  const cadtest::TemporaryFolder folder;
  const std::string path = folder.file("box.step");
  cadtest::writeShape(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), path);
  auto lines = cadtest::linesOf(path);
  int number = 0;
  for (std::string& line : lines)
  {
    const std::size_t at = line.find("= PLANE('");
    if (number == 0 && at != std::string::npos)
    {
      number = std::stoi(line.substr(1));
      line = "#" + std::to_string(number) + " = PLANE('',7.);";
    }
  }
  ASSERT_GT(number, 0);
  cadtest::writeLines(path, lines);
  const auto model = cadrefine::readCADFile(path);
  EXPECT_EQ(model->count(2), 5);
  ASSERT_FALSE(model->unread().empty());
  EXPECT_EQ(model->unread()[0].entity, number);
  EXPECT_EQ(model->unread()[0].type, "STEP PLANE");
  EXPECT_NE(model->unread()[0].reason, "");
}

} // namespace
