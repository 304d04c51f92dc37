// Broken entities are listed by number, type and reason, and the rest of the file is read.

#include "CADFile.h"
#include "TestFiles.h"

#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepPrimAPI_MakeBox.hxx>

#include <gtest/gtest.h>

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

TEST_F(Unread, AnIntactFileHasNone)
{
  const auto model = cadrefine::readCADFile(this->path);
  EXPECT_EQ(model->count(2), 6);
  EXPECT_TRUE(model->unread().empty());
}

TEST_F(Unread, ABrokenSurfaceIsListed)
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

TEST_F(Unread, ABrokenFaceIsListed)
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

TEST_F(Unread, AFileWithNothingLeftIsAnErrorThatNamesTheEntities)
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

TEST(UnreadStep, ABrokenFaceIsListedByItsNumber)
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
