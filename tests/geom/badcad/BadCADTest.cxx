// Every file, however damaged, ends with a model that can be used or with one clear error, within
// bounds of time and memory. Each is read in a process of its own (ReadProbe.h).

#include "BadFiles.h"
#include "Mutation.h"
#include "ReadProbe.h"
#include "Tally.h"
#include "TestFiles.h"

#include <cadrefine/cad/import/CADFile.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <ostream>

namespace badcad
{

void PrintTo(const BadFile& file, std::ostream* stream)
{
  *stream << file.name;
}

} // namespace badcad

namespace
{

using badcad::BadFile;

class BadCAD : public testing::Test
{
protected:
  /// A row of the table, whose columns badcad_table names.
  void TearDown() override
  {
    if (this->tally.inputs > 0)
    {
      this->tally.print(testing::UnitTest::GetInstance()->current_test_info()->name());
    }
  }

  void expectGoodEnding(const BadFile& file)
  {
    constexpr double wallSeconds = 300; // far beyond all limits of the reader itself
    constexpr double mostSeconds = 30;
    constexpr double mostMegabytes = 4096;
    const std::string path = this->folder.write("case" + file.extension, file.text);
    const badcad::ReadOutcome outcome = badcad::probe(path, wallSeconds);
    this->tally.add(outcome);
    EXPECT_TRUE(outcome.isGood()) << file.name << ": " << outcome.text;
    EXPECT_LT(outcome.seconds, mostSeconds) << file.name << ": " << outcome.text;
    EXPECT_LT(outcome.megabytes, mostMegabytes) << file.name << ": " << outcome.text;
  }

  void expectGoodEndings(const std::vector<BadFile>& files)
  {
    for (const BadFile& file : files)
    {
      this->expectGoodEnding(file);
    }
  }

  cadtest::TemporaryFolder folder;
  badcad::Tally tally;
};

std::string textOf(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  return { std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>() };
}

const std::string data = CADREFINE_DATA "/";
const std::string samples = "/usr/share/opencascade/data/";

TEST_F(BadCAD, igesMadeByPrograms)
{
  this->expectGoodEndings(badcad::badIgesFiles());
}

TEST_F(BadCAD, stepMadeByPrograms)
{
  this->expectGoodEndings(badcad::badStepFiles());
}

TEST_F(BadCAD, brepMadeByPrograms)
{
  this->expectGoodEndings(badcad::badBrepFiles());
}

TEST_F(BadCAD, splinesInStepAndBrep)
{
  this->expectGoodEndings(badcad::badSplineFiles());
}

TEST_F(BadCAD, randomBytes)
{
  this->expectGoodEndings(badcad::garbageFiles());
}

TEST_F(BadCAD, binaryBrep)
{
  const BadFile sound = badcad::soundBinaryBrep();
  this->expectGoodEndings(badcad::cutAnywhere(sound, 40));
  for (std::uint64_t seed = 1; seed <= 60; ++seed)
  {
    this->expectGoodEnding(
      { "seed " + std::to_string(seed), sound.extension, badcad::mutate(sound.text, seed) });
  }
}

TEST_F(BadCAD, shapesThatAreNoModels)
{
  this->expectGoodEndings(badcad::badShapes());
}

TEST_F(BadCAD, cutOffInEachLine)
{
  for (const char* name : { "three_arcs.igs", "three_arcs_nurbs.igs", "cylinder.brep" })
  {
    const std::string extension = std::filesystem::path(name).extension().string();
    this->expectGoodEndings(badcad::cutFiles(textOf(data + name), extension));
  }
  this->expectGoodEndings(badcad::cutFiles(badcad::soundStep().text, ".step"));
}

/// A face that is there 10,000 times is read once.
TEST_F(BadCAD, manyPatchesInOnePlace)
{
  const BadFile file = badcad::dearFiles().front();
  const auto model = cadrefine::readCADFile(this->folder.write("crowd.igs", file.text));
  EXPECT_EQ(model->count(2), 1);
  ASSERT_EQ(model->report().leftOut.size(), 9999u);
  EXPECT_GT(model->report().leftOut.front().entity, 0);
  EXPECT_EQ(model->report().leftOut.front().reason, "is a duplicate of another face");
}

/// Of a bad surface and a sound one, the sound one is read, and the bad one is listed unless it is
/// only odd.
TEST_F(BadCAD, soundFacesAreNotLost)
{
  const auto isBeside = [](const BadFile& file)
  { return file.name.find(", and a sound face") != std::string::npos; };
  int read = 0;
  for (const BadFile& file : badcad::badIgesFiles())
  {
    if (isBeside(file))
    {
      const auto model = cadrefine::readCADFile(this->folder.write("two.igs", file.text));
      EXPECT_GE(model->count(2) + static_cast<int>(model->unread().size()), 2) << file.name;
      EXPECT_LT(model->nearest({ 3.5, 0.5, 1 }).distance, 1.01 + 1e-9 * model->size()) << file.name;
      ++read;
    }
  }
  EXPECT_GT(read, 50);
}

/// A file, and how many mutations of it are read.
struct Mutated
{
  std::string path;
  int count = 0;
};

void PrintTo(const Mutated& shown, std::ostream* stream)
{
  *stream << shown.count << " of " << shown.path;
}

class Mutations
  : public BadCAD
  , public testing::WithParamInterface<Mutated>
{
};

TEST_P(Mutations, endWell)
{
  const std::string text = textOf(GetParam().path);
  ASSERT_FALSE(text.empty()) << GetParam().path;
  const std::string extension = std::filesystem::path(GetParam().path).extension().string();
  for (int seed = 1; seed <= GetParam().count; ++seed)
  {
    this->expectGoodEnding({ "seed " + std::to_string(seed), extension,
      badcad::mutate(text, static_cast<std::uint64_t>(seed)) });
  }
}

INSTANTIATE_TEST_SUITE_P(Files, Mutations,
  testing::Values(Mutated{ data + "three_arcs.igs", 80 },
    Mutated{ data + "three_arcs_nurbs.igs", 80 }, Mutated{ data + "naca0012_sharp.igs", 20 },
    Mutated{ data + "cylinder.brep", 100 },
    Mutated{
      "/usr/share/doc/libdeal.ii-doc/examples/step-54/input/DTMB-5415_bulbous_bow.iges", 60 },
    Mutated{ samples + "step/screw.step", 80 }, Mutated{ samples + "occ/wing.brep", 60 },
    Mutated{ samples + "occ/face1.brep", 60 }));

} // namespace
