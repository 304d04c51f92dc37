// Coordinates are the file's own numbers, whatever its unit, or converted where that is asked for.

#include "TestFiles.h"

#include <cadrefine/base/Error.h>
#include <cadrefine/cad/import/CADFile.h>
#include <cadrefine/cad/model/ModelDrawing.h>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <ostream>

namespace
{

using namespace cadrefine;

struct UnitCase
{
  const char* extension;
  const char* unit;   ///< As Open CASCADE spells it.
  const char* name;   ///< As the model names it.
  double millimetres; ///< Its length.
};

void PrintTo(const UnitCase& tried, std::ostream* out)
{
  *out << tried.name << " in " << tried.extension;
}

class Units : public testing::TestWithParam<UnitCase>
{
};

INSTANTIATE_TEST_SUITE_P(Files, Units,
  testing::Values(UnitCase{ ".igs", "INCH", "in", 25.4 }, UnitCase{ ".igs", "M", "m", 1000 },
    UnitCase{ ".igs", "MM", "mm", 1 }, UnitCase{ ".step", "INCH", "in", 25.4 },
    UnitCase{ ".step", "M", "m", 1000 }, UnitCase{ ".step", "MM", "mm", 1 }),
  [](const auto& c) { return std::string(c.param.extension + 1) + "_" + c.param.name; });

TEST_P(Units, keepTheFilesOwnNumbers)
{
  const cadtest::TemporaryFolder folder;
  const UnitCase& c = GetParam();
  const std::string path = folder.file(std::string("box") + c.extension);
  // Open CASCADE takes its coordinates for millimetres, so 1 x 2 x 3 units must be scaled for it.
  const double mm = c.millimetres;
  cadtest::writeShape(BRepPrimAPI_MakeBox(mm, 2 * mm, 3 * mm).Shape(), path, c.unit);
  const auto model = readCADFile(path);
  EXPECT_EQ(model->unit(), c.name);
  EXPECT_NEAR(model->size(), std::sqrt(14.0), 1e-9);
  Point3 high{};
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

TEST(UnitsOfBrep, areUnknown)
{
  const cadtest::TemporaryFolder folder;
  cadtest::writeShape(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), folder.file("box.brep"));
  EXPECT_EQ(readCADFile(folder.file("box.brep"))->unit(), "");
}

TEST_P(Units, areConverted)
{
  const cadtest::TemporaryFolder folder;
  const UnitCase& c = GetParam();
  const std::string path = folder.file(std::string("cylinder") + c.extension);
  const double mm = c.millimetres;
  cadtest::writeShape(BRepPrimAPI_MakeCylinder(2 * mm, 3 * mm).Shape(), path, c.unit);
  const auto own = readCADFile(path);
  for (const auto& [unit, length] : std::map<std::string, double>{ { "m", 1000 }, { "cm", 10 },
         { "mm", 1 }, { "in", 25.4 }, { "inch", 25.4 }, { "Feet", 304.8 } })
  {
    SCOPED_TRACE(unit);
    const auto model = readCADFile(path, unit);
    const double factor = c.millimetres / length;
    EXPECT_EQ(model->unit(), unit == "inch" ? "in" : unit == "Feet" ? "ft" : unit);
    EXPECT_NEAR(model->size(), factor * own->size(), 1e-14 * model->size());
    EXPECT_NEAR(model->measure({ 2, 0 }), factor * factor * own->measure({ 2, 0 }),
      1e-12 * model->size() * model->size());
    for (const Point3& p :
      { Point3{ 3, 1, 2 }, Point3{ 0.3, 1, 5 }, Point3{ 1, 0.5, 1.25 }, Point3{ 2, 2, 3 } })
    {
      const auto expected = own->nearest(p);
      const auto found = model->nearest(factor * p);
      EXPECT_EQ(found.entity, expected.entity);
      EXPECT_NEAR(found.distance, factor * expected.distance, 1e-9 * model->size());
      EXPECT_LT(distance(found.point, factor * expected.point), 1e-8 * model->size());
      EXPECT_LT(distance(model->evaluate(found.entity, found.parameters), found.point),
        1e-12 * model->size());
    }
    const Tessellation drawing = drawModel(*model, 1e-3 * model->size()).faces.at(0);
    ASSERT_FALSE(drawing.points.empty());
    for (const auto& point : drawing.points)
    {
      EXPECT_LT(model->nearest(point).distance, 1e-2 * model->size());
    }
  }
}

/// Not by a factor that is rounded first: 3 mm are 0.003 m, as a mesh file has it.
TEST(UnitsOfLength, areDecimalWhereTheyCanBe)
{
  const cadtest::TemporaryFolder folder;
  cadtest::writeShape(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), folder.file("box.step"), "MM");
  const auto model = readCADFile(folder.file("box.step"), "m");
  const auto [low, high] = model->box();
  EXPECT_EQ(high, (Point3{ 0.001, 0.002, 0.003 }));
  EXPECT_EQ(low, (Point3{ 0, 0, 0 }));
}

TEST(UnitsOfBrep, areTakenAsMillimetres)
{
  const cadtest::TemporaryFolder folder;
  cadtest::writeShape(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), folder.file("box.brep"));
  const auto model = readCADFile(folder.file("box.brep"), "m");
  EXPECT_EQ(model->unit(), "m");
  EXPECT_NEAR(model->size(), std::sqrt(14.0) / 1000, 1e-15);
  ASSERT_EQ(model->report().repairs.size(), 1u);
  EXPECT_NE(model->report().repairs[0].find("names no unit"), std::string::npos);
}

TEST(UnitsOfLength, areRefusedWhereTheyAreNotKnown)
{
  try
  {
    readCADFile("none.step", "furlong");
    FAIL();
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("\"furlong\" (Unit)"), std::string::npos)
      << error.what();
  }
}

} // namespace
