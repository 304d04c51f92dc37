// Every error is one line that names the file and the reason.

#include "TestFiles.h"

#include <cadrefine/cad/import/CADFile.h>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>

#include <gtest/gtest.h>

#include <algorithm>
#include <sys/stat.h>
#include <unistd.h>

namespace
{

void expectError(const std::string& path, const std::string& reason)
{
  const std::string error = cadtest::errorOfReading(path);
  EXPECT_EQ(error.compare(0, path.size(), path), 0) << error;
  EXPECT_NE(error.find(reason), std::string::npos) << error;
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

class FileErrors : public testing::Test
{
protected:
  cadtest::TemporaryFolder folder;
};

TEST_F(FileErrors, noSuchFile)
{
  expectError(this->folder.file("missing.igs"), "no such file");
}

TEST_F(FileErrors, directory)
{
  std::filesystem::create_directory(this->folder.file("folder.igs"));
  expectError(this->folder.file("folder.igs"), "directory");
}

TEST_F(FileErrors, pipe)
{
  const std::string path = this->folder.file("pipe.igs");
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  expectError(path, "is a device or a pipe");
}

TEST_F(FileErrors, hole)
{
  constexpr std::uintmax_t gigabyte = 1000000000;
  const std::string start = "Nothing follows" + std::string(57, ' ') + "S      1\n";
  for (const std::string& path :
    { this->folder.write("a.igs", start), this->folder.write("a.step", "ISO-10303-21;\n"),
      this->folder.write("a.brep", "DBRep_DrawableShape\n\nCASCADE Topology V1, (c)\n") })
  {
    std::filesystem::resize_file(path, gigabyte);
    expectError(path, "zeros instead of text from byte 4096 on");
  }
  const std::string empty = this->folder.write("b.igs", "");
  std::filesystem::resize_file(empty, gigabyte);
  expectError(empty, "does not begin like");
}

TEST_F(FileErrors, noPermission)
{
  const std::string path = this->folder.write("secret.igs", "text");
  ASSERT_EQ(chmod(path.c_str(), 0), 0);
  ASSERT_EQ(chmod(std::filesystem::path(path).parent_path().c_str(), 0755), 0);
  // The superuser may read everything: be nobody for a moment.
  constexpr uid_t nobody = 65534;
  const bool root = geteuid() == 0;
  ASSERT_TRUE(!root || seteuid(nobody) == 0);
  const std::string error = cadtest::errorOfReading(path);
  ASSERT_TRUE(!root || seteuid(0) == 0);
  EXPECT_NE(error.find("Permission denied"), std::string::npos) << error;
}

TEST_F(FileErrors, emptyFile)
{
  for (const char* name : { "a.igs", "a.iges", "a.stp", "a.step", "a.brep", "A.IGS" })
  {
    expectError(this->folder.write(name, ""), "empty");
  }
}

TEST_F(FileErrors, unknownExtension)
{
  expectError(this->folder.write("a.stl", "solid"), "extension '.stl'");
  expectError(this->folder.write("a", "solid"), "extension ''");
}

TEST_F(FileErrors, textThatIsNoCAD)
{
  const std::string text(500, 'x');
  expectError(this->folder.write("a.igs", text), "IGES");
  expectError(this->folder.write("a.step", text), "STEP");
  expectError(this->folder.write("a.brep", text), "BREP");
  expectError(this->folder.write("b.igs", "Once upon a time\nthere was no CAD.\n"), "IGES");
}

TEST_F(FileErrors, filesThatOnlyBeginWell)
{
  expectError(this->folder.write("a.step", "ISO-10303-21;\nHEADER;\nnonsense"), "STEP");
  expectError(
    this->folder.write("a.brep", "DBRep_DrawableShape\n\nCASCADE Topology V1\nLocations 7\n"), "");
  const std::string start = "Nothing follows" + std::string(57, ' ') + "S      1\n";
  expectError(this->folder.write("a.igs", start), "");
}

/// Open CASCADE would read the face, and crash on it.
TEST_F(FileErrors, faceWithoutASurfaceIsLostAlone)
{
  const std::string path = this->folder.file("box.brep");
  cadtest::writeShape(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), path);
  std::vector<std::string> lines = cadtest::linesOf(path);
  const auto surfaces = std::find(lines.begin(), lines.end(), "Surfaces 6");
  ASSERT_TRUE(surfaces != lines.end());
  *(surfaces + 1) = "9 0 0 0 0 1 1 2 2 2 2 0 0 0 0 1 0 1 0 0 1 1 0 0 2 0 2 0 2 1 2"; // equal knots
  cadtest::writeLines(path, lines);
  const auto model = cadrefine::readCADFile(path);
  EXPECT_EQ(model->count(2), 5);
  ASSERT_EQ(model->unread().size(), 1u);
  EXPECT_EQ(model->unread()[0].entity, 1);
  EXPECT_EQ(model->unread()[0].type, "BREP face");
  EXPECT_EQ(model->unread()[0].reason, "has no surface that can be read");
}

/// Open CASCADE never ends on points at infinity.
TEST_F(FileErrors, numbersBeyondDouble)
{
  const std::string path = this->folder.file("box.step");
  cadtest::writeShape(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), path);
  std::vector<std::string> lines = cadtest::linesOf(path);
  for (std::string& line : lines)
  {
    if (line.find("#12 = CARTESIAN_POINT('',(0.,0.,0.))") == 0)
    {
      line = "#12 = CARTESIAN_POINT('it''s 1.E777',(1.E300,0.0E999,1.E-999),-2.E999);";
    }
  }
  cadtest::writeLines(path, lines);
  expectError(path, "#12 holds a number that is too large, -2.E999");
}

TEST_F(FileErrors, cutShort)
{
  for (const char* extension : { ".igs", ".step", ".brep" })
  {
    const std::string path = this->folder.file(std::string("box") + extension);
    cadtest::writeShape(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), path);
    const auto size = std::filesystem::file_size(path);
    std::filesystem::resize_file(path, size / 2);
    const std::string error = cadtest::errorOfReading(path);
    EXPECT_TRUE(error.empty() || error.find(path) == 0) << error;
  }
}

TEST_F(FileErrors, nothingInside)
{
  TopoDS_Compound nothing;
  BRep_Builder().MakeCompound(nothing);
  const std::string path = this->folder.file("nothing.brep");
  cadtest::writeShape(nothing, path);
  expectError(path, "no face or curve");
}

} // namespace
