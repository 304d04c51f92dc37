// Faults of files in the wild: what can be repaired safely is, and is told; the rest is listed.

#include "IgesCases.h"
#include "TestFiles.h"

#include <cadrefine/cad/import/CADFile.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace
{

using namespace cadrefine;
using namespace cadtest;

using Lines = std::vector<std::string>;

/// A sound file: a trimmed surface with a long name, an arc and a line.
Lines soundLines()
{
  IgesWriter file;
  const std::string longName = "a name, longer than one line of parameters; with all delimiters in";
  IgesAttributes named;
  named.properties = { file.add(406, igesValues(1, longName), withForm(15)) };
  addSquare(file, { 0.125, 0.25, 1.5e-3 }, named);
  addArc(file, 0, { 5, 0, 6, 0, 4, 0 });
  addLine(file, { 0, 3, 0 }, { 1, 3, 0 });
  return file.lines();
}

char sectionOf(const std::string& line)
{
  return line[72];
}

class IgesRepairs : public testing::Test
{
protected:
  std::shared_ptr<const CADModel> read(const std::string& text) const
  {
    return readCADFile(folder.write("sloppy.igs", text));
  }

  std::shared_ptr<const CADModel> read(const Lines& lines, const std::string& lineEnd = "\n") const
  {
    std::string text;
    for (const std::string& line : lines)
    {
      text += line + lineEnd;
    }
    return read(text);
  }

  /// The file gives the model of the sound one; `repair` is told, and nothing else ("": nothing).
  static void expectSame(const CADModel& model, const std::string& repair)
  {
    EXPECT_EQ(model.count(2), 1);
    EXPECT_EQ(model.count(1), 6);
    EXPECT_TRUE(model.unread().empty());
    EXPECT_LT(model.nearest({ 0.5, 0.5, 1.5e-3 }).distance, 1e-12);
    EXPECT_NEAR(model.nearest({ 5, 3, 0 }).distance, 2, 1e-9);
    EXPECT_NEAR(model.nearest({ 0.5, 4, 0 }).distance, 1, 1e-9);
    EXPECT_EQ(model.attributes({ 2, 0 }).name,
      "a name, longer than one line of parameters; with all delimiters in");
    const auto& repairs = model.report().repairs;
    EXPECT_EQ(repairs.size(), repair.empty() ? 0u : 1u);
    for (const std::string& told : repairs)
    {
      EXPECT_NE(told.find(repair), std::string::npos) << told;
    }
  }

  Lines sound = soundLines();
  TemporaryFolder folder;
};

TEST_F(IgesRepairs, aSoundFileNeedsNone)
{
  expectSame(*this->read(this->sound), "");
}

TEST_F(IgesRepairs, lineEndsOfOtherSystems)
{
  expectSame(*this->read(this->sound, "\r\n"), "");
  expectSame(*this->read(this->sound, "\r"), "");
}

TEST_F(IgesRepairs, trailingBlanks)
{
  expectSame(*this->read(this->sound, std::string(40, ' ') + "\n"), "more than 80 columns");
}

TEST_F(IgesRepairs, blankLinesAndAnEndOfFileMark)
{
  Lines lines = this->sound;
  lines.insert(lines.begin() + 3, "");
  lines.emplace_back("\x1a");
  expectSame(*this->read(lines), "");
}

TEST_F(IgesRepairs, tabs)
{
  Lines expanded = this->sound;
  Lines single = this->sound;
  for (std::size_t i = 0; i < expanded.size(); ++i)
  {
    std::string& line = expanded[i];
    if (sectionOf(line) == 'P' && line.substr(40, 24) == std::string(24, ' '))
    {
      line = line.substr(0, 40) + "\t\t\t" + line.substr(64);
      single[i][50] = '\t';
    }
  }
  ASSERT_NE(expanded, this->sound);
  expectSame(*this->read(expanded), "hold tabs");
  expectSame(*this->read(single), "hold tabs");
}

TEST_F(IgesRepairs, noTerminateSection)
{
  Lines lines = this->sound;
  lines.pop_back();
  expectSame(*this->read(lines), "terminate section is missing");
}

TEST_F(IgesRepairs, wrongCountsAtTheEnd)
{
  Lines lines = this->sound;
  lines.back().replace(17, 7, "     99");
  expectSame(*this->read(lines), "counts 99 D lines");
}

TEST_F(IgesRepairs, wrongSequenceNumbers)
{
  Lines lines = this->sound;
  for (std::string& line : lines)
  {
    if (sectionOf(line) == 'D')
    {
      line.replace(73, 7, "      7");
    }
  }
  expectSame(*this->read(lines), "wrong sequence numbers");
}

TEST_F(IgesRepairs, wrongParameterPointersAndLineCounts)
{
  Lines lines = this->sound;
  bool first = true;
  for (std::string& line : lines)
  {
    if (sectionOf(line) == 'D')
    {
      line.replace(first ? 8 : 24, 8, first ? "       3" : "       9");
      first = !first;
    }
  }
  expectSame(*this->read(lines), "wrong parameter lines or counts");
}

TEST_F(IgesRepairs, wrongEntryNumbersInParameterLines)
{
  Lines lines = this->sound;
  for (std::string& line : lines)
  {
    if (sectionOf(line) == 'P')
    {
      line.replace(64, 8, std::string(8, ' '));
    }
  }
  expectSame(*this->read(lines), "name wrong directory entries");
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
  const std::size_t at = text.find(from);
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST_F(IgesRepairs, exponentsOfAllKinds)
{
  for (const char* number : { "1.5E-3", "1.5e-3", "1.5D-3", "1.5d-3", "+1.5D-03", "15.d-4" })
  {
    IgesWriter file;
    file.add(110, { "0.", "0.", number, "1", "0", number });
    const auto model = readWritten(file);
    ASSERT_EQ(model->count(1), 1) << number;
    EXPECT_LT(model->nearest({ 0.5, 0, 1.5e-3 }).distance, 1e-15) << number;
    EXPECT_TRUE(model->unread().empty());
  }
}

/// Drops the terminator of the entity whose parameters begin with `type`.
Lines withoutTerminator(Lines lines, const std::string& type)
{
  bool inside = false;
  for (std::string& line : lines)
  {
    inside = sectionOf(line) == 'P' && (inside || line.compare(0, 4, type + ",") == 0);
    if (inside && line.find(';') != std::string::npos)
    {
      line = replaced(line, ";", " ");
      return lines;
    }
  }
  return lines;
}

TEST_F(IgesRepairs, aMissingTerminator)
{
  for (const char* type : { "128", "144", "100", "110" })
  {
    const Lines lines = withoutTerminator(this->sound, type);
    ASSERT_NE(lines, this->sound);
    expectSame(*this->read(lines), "have no terminator");
  }
}

TEST_F(IgesRepairs, aCutNumberIsNotGuessed)
{
  // The file ends in the middle of the last number: what is missing cannot be known.
  Lines lines = withoutTerminator(this->sound, "110");
  lines.pop_back();
  const auto model = this->read(lines);
  EXPECT_EQ(model->count(1), 5);
  ASSERT_EQ(model->unread().size(), 1u);
  EXPECT_EQ(model->unread()[0].reason, "its parameters have no end");
}

TEST_F(IgesRepairs, stringsThatCrossLinesKeepEveryColumn)
{
  // The name of the sound file does; here a repair makes the parameters be wrapped anew as well.
  Lines lines = this->sound;
  lines.pop_back();
  expectSame(*this->read(lines), "terminate section");
}

TEST_F(IgesRepairs, severalAreAllTold)
{
  Lines lines = withoutTerminator(this->sound, "100");
  lines.pop_back();
  EXPECT_EQ(this->read(lines, "  \r\n")->report().repairs.size(), 3u);
}

} // namespace
