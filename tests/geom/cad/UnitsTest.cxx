// Coordinates are the file's own numbers, whatever its unit.

#include "CADFile.h"
#include "TestFiles.h"

#include <BRepPrimAPI_MakeBox.hxx>

#include <gtest/gtest.h>

namespace
{

struct UnitCase
{
  const char* extension;
  const char* unit;   ///< As Open CASCADE spells it.
  const char* name;   ///< As the model names it.
  double millimetres; ///< Its length.
};

class Units : public testing::TestWithParam<UnitCase>
{
};

INSTANTIATE_TEST_SUITE_P(Files, Units,
  testing::Values(UnitCase{ ".igs", "INCH", "in", 25.4 }, UnitCase{ ".igs", "M", "m", 1000 },
    UnitCase{ ".igs", "MM", "mm", 1 }, UnitCase{ ".step", "INCH", "in", 25.4 },
    UnitCase{ ".step", "M", "m", 1000 }, UnitCase{ ".step", "MM", "mm", 1 }),
  [](const auto& c) { return std::string(c.param.extension + 1) + "_" + c.param.name; });

TEST_P(Units, KeepTheFilesOwnNumbers)
{
  const cadtest::TemporaryFolder folder;
  const UnitCase& c = GetParam();
  const std::string path = folder.file(std::string("box") + c.extension);
  // Open CASCADE takes its coordinates for millimetres, so 1 x 2 x 3 units must be scaled for it.
  const double mm = c.millimetres;
  cadtest::writeShape(BRepPrimAPI_MakeBox(mm, 2 * mm, 3 * mm).Shape(), path, c.unit);
  const auto model = cadrefine::readCADFile(path);
  EXPECT_EQ(model->unit(), c.name);
  EXPECT_NEAR(model->size(), std::sqrt(14.0), 1e-9);
  cadrefine::Point3 high{};
  for (const auto& vertex : model->nurbs().vertices)
  {
    for (int k = 0; k < 3; ++k)
    {
      high[k] = std::max(high[k], vertex.point[k]);
    }
  }
  EXPECT_NEAR(high[0], 1, 1e-12);
  EXPECT_NEAR(high[1], 2, 1e-12);
  EXPECT_NEAR(high[2], 3, 1e-12);
}

TEST(UnitsOfBrep, AreUnknown)
{
  const cadtest::TemporaryFolder folder;
  cadtest::writeShape(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), folder.file("box.brep"));
  EXPECT_EQ(cadrefine::readCADFile(folder.file("box.brep"))->unit(), "");
}

} // namespace
