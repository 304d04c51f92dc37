// Units, transformations, and what the status of an entity says of its place in the model.

#include "IgesCases.h"
#include "TestFiles.h"

#include <cadrefine/cad/import/CADFile.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace
{

using namespace cadrefine;
using namespace cadtest;

IgesAttributes blanked()
{
  IgesAttributes attributes;
  attributes.blanked = true;
  return attributes;
}

IgesAttributes ofUse(IgesUse use)
{
  IgesAttributes attributes;
  attributes.use = use;
  return attributes;
}

IgesAttributes moved(int matrix)
{
  IgesAttributes attributes;
  attributes.transformation = matrix;
  return attributes;
}

/// Reason of the only entity that was left out.
std::string leftOut(const CADModel& model)
{
  const auto& list = model.report().leftOut;
  return list.size() == 1 ? list[0].reason : "(" + std::to_string(list.size()) + " left out)";
}

struct UnitCase
{
  int flag;
  const char* inFile;
  const char* name;
};

void PrintTo(const UnitCase& tried, std::ostream* out)
{
  *out << tried.name;
}

class IgesUnits : public testing::TestWithParam<UnitCase>
{
};

INSTANTIATE_TEST_SUITE_P(Flags, IgesUnits,
  testing::Values(UnitCase{ 1, "INCH", "in" }, UnitCase{ 2, "MM", "mm" }, UnitCase{ 4, "FT", "ft" },
    UnitCase{ 5, "MI", "mi" }, UnitCase{ 6, "M", "m" }, UnitCase{ 7, "KM", "km" },
    UnitCase{ 8, "MIL", "mil" }, UnitCase{ 9, "UM", "um" }, UnitCase{ 10, "CM", "cm" },
    UnitCase{ 11, "UIN", "uin" }, UnitCase{ 3, "Furlong", "furlong" }, UnitCase{ 3, "INCH", "in" }),
  [](const auto& c)
  { return std::string("Flag") + std::to_string(c.param.flag) + c.param.inFile; });

TEST_P(IgesUnits, areNamedAndScaleNothing)
{
  IgesWriter file;
  file.setUnit(GetParam().flag, GetParam().inFile);
  const int matrix =
    file.add(124, igesValues(1.0, 0.0, 0.0, 10.0, 0.0, 1.0, 0.0, 20.0, 0.0, 0.0, 1.0, 30.0));
  addSquare(file, { 1, 2, 3 }, moved(matrix));
  const auto model = readWritten(file);
  EXPECT_EQ(model->unit(), GetParam().name);
  EXPECT_NEAR(model->size(), std::sqrt(2), 1e-6);
  EXPECT_LT(model->nearest({ 11.5, 22.5, 33 }).distance, 1e-9);
  EXPECT_NEAR(model->nearest({ 11, 22, 35 }).distance, 2, 1e-9);
}

TEST(IgesMatrices, nestTwice)
{
  // First a quarter turn round z, then a shift along x; then, by the outer one, a mirror image
  // moved along z.
  IgesWriter file;
  const int outer = file.add(
    124, igesValues(1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 7.0), withForm(1));
  IgesAttributes inner = moved(outer);
  const int turn =
    file.add(124, igesValues(0.0, -1.0, 0.0, 5.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0), inner);
  addLine(file, { 1, 0, 0 }, { 2, 0, 0 }, moved(turn));
  const auto model = readWritten(file);
  ASSERT_EQ(model->count(1), 1);
  std::array<Point3, 2> ends{ model->nurbs().vertices[0].point, model->nurbs().vertices[1].point };
  std::sort(ends.begin(), ends.end());
  EXPECT_LT(distance(ends[0], { 5, -2, 7 }), 1e-12);
  EXPECT_LT(distance(ends[1], { 5, -1, 7 }), 1e-12);
}

TEST(IgesMatrices, mayMirrorAndScaleFaces)
{
  IgesWriter file;
  const int matrix =
    file.add(124, igesValues(-2.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 2.0, 1.0));
  addSquare(file, { 1, 0, 0 }, moved(matrix));
  const auto model = readWritten(file);
  EXPECT_EQ(model->count(2), 1);
  EXPECT_LT(model->nearest({ -3, 1, 1 }).distance, 1e-9);
  EXPECT_NEAR(model->nearest({ 0, 1, 1 }).distance, 2, 1e-9);
  EXPECT_NEAR(model->nearest({ -5, 1, 1 }).distance, 1, 1e-9);
}

TEST(IgesMatrices, thatDistortAreListedOnceAndPlaceNothing)
{
  IgesWriter file;
  const int matrix =
    file.add(124, igesValues(2.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0));
  addSquare(file, { 0, 0, 0 }, moved(matrix));
  addLine(file, { 0, 5, 0 }, { 1, 5, 0 });
  const auto model = readWritten(file);
  EXPECT_EQ(model->count(2), 0);
  EXPECT_EQ(model->count(1), 1);
  ASSERT_EQ(model->unread().size(), 1u);
  EXPECT_EQ(model->unread()[0].entity, matrix);
  EXPECT_NE(model->unread()[0].reason.find("distorts"), std::string::npos);
}

TEST(IgesMatrices, ofPartAndWholeBothApply)
{
  // A surface turned by its own matrix, in a trimmed surface that is moved as a whole.
  IgesWriter file;
  const int turn =
    file.add(124, igesValues(0.0, -1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0));
  const int shift =
    file.add(124, igesValues(1.0, 0.0, 0.0, 10.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0));
  IgesAttributes part = dependent();
  part.transformation = turn;
  const int surface =
    addBilinear(file, { { 0, 0, 0 }, { 2, 0, 0 }, { 0, 1, 0 }, { 2, 1, 0 } }, part);
  file.add(144, igesValues(surface, 0, 0, 0), moved(shift));
  const auto model = readWritten(file);
  EXPECT_EQ(model->count(2), 1);
  EXPECT_LT(model->nearest({ 9.5, 1.5, 0 }).distance, 1e-9);
  EXPECT_NEAR(model->nearest({ 11, 1, 0 }).distance, 1, 1e-9);
}

TEST(IgesStatus, blankedEntitiesAreLeftOutAndListed)
{
  IgesWriter file;
  addSquare(file, { 0, 0, 0 }, {});
  const int hidden = [&]
  {
    addSquare(file, { 5, 0, 0 }, blanked());
    return addLine(file, { 0, 3, 0 }, { 1, 3, 0 }, blanked());
  }();
  const auto model = readWritten(file);
  EXPECT_EQ(model->count(2), 1);
  EXPECT_EQ(model->count(1), 4);
  EXPECT_TRUE(model->unread().empty());
  ASSERT_EQ(model->report().leftOut.size(), 2u);
  EXPECT_EQ(model->report().leftOut[0].type, "IGES 144 (trimmed surface)");
  EXPECT_EQ(model->report().leftOut[1].entity, hidden);
  EXPECT_EQ(model->report().leftOut[1].reason, "blanked");
}

TEST(IgesStatus, aFileOfBlankedEntitiesIsReadAndSaysSo)
{
  IgesWriter file;
  addLine(file, { 0, 3, 0 }, { 1, 3, 0 }, blanked());
  const auto model = readWritten(file);
  EXPECT_EQ(model->count(1), 1);
  EXPECT_TRUE(model->report().leftOut.empty());
  ASSERT_EQ(model->report().repairs.size(), 1u);
  EXPECT_EQ(
    model->report().repairs[0], "all of its geometry is blanked, but was read nevertheless");
}

TEST(IgesStatus, aBlankedPartOfAVisibleWholeIsRead)
{
  IgesWriter file;
  IgesAttributes part = dependent();
  part.blanked = true;
  const int surface =
    addBilinear(file, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } }, part);
  file.add(144, igesValues(surface, 0, 0, 0));
  const auto model = readWritten(file);
  EXPECT_EQ(model->count(2), 1);
  EXPECT_TRUE(model->report().leftOut.empty());
}

TEST(IgesStatus, dependentEntitiesAreReadOnceWithTheirParent)
{
  for (const int subordinate : { 0, 1, 2, 3 })
  {
    IgesAttributes part;
    part.subordinate = subordinate;
    IgesWriter file;
    const int surface =
      addBilinear(file, { { -2, -2, 0 }, { 2, -2, 0 }, { -2, 2, 0 }, { 2, 2, 0 } }, part);
    const int round =
      addPolygon(file, { { -1, -1, 0 }, { 1, -1, 0 }, { 1, 1, 0 }, { -1, 1, 0 } }, part);
    const int loop = file.add(142, igesValues(0, surface, 0, round, 2), part);
    file.add(144, igesValues(surface, 1, 0, loop));
    const auto model = readWritten(file);
    EXPECT_EQ(model->count(2), 1) << subordinate;
    EXPECT_EQ(model->count(1), 4) << subordinate;
    EXPECT_NEAR(model->nearest({ 2, 0, 0 }).distance, 1, 1e-9) << subordinate;
  }
}

TEST(IgesStatus, aDependentEntityThatNothingRefersToIsRead)
{
  IgesWriter file;
  addLine(file, { 0, 0, 0 }, { 1, 0, 0 }, dependent());
  EXPECT_EQ(readWritten(file)->count(1), 1);
}

TEST(IgesStatus, onlyGeometryIsPartOfTheModel)
{
  for (const IgesUse use : { IgesUse::Annotation, IgesUse::Definition, IgesUse::Other,
         IgesUse::Logical, IgesUse::Parametric, IgesUse::Construction })
  {
    IgesWriter file;
    addLine(file, { 0, 0, 0 }, { 1, 0, 0 });
    addLine(file, { 0, 1, 0 }, { 1, 1, 0 }, ofUse(use));
    const auto model = readWritten(file);
    EXPECT_EQ(model->count(1), 1);
    EXPECT_NEAR(model->nearest({ 0, 1, 0 }).distance, 1, 1e-12);
    EXPECT_NE(leftOut(*model).find("(use flag 0" + std::to_string(static_cast<int>(use))),
      std::string::npos)
      << leftOut(*model);
  }
}

TEST(IgesStatus, constructionGeometryIsReadWhereThereIsNothingElse)
{
  IgesWriter file;
  addLine(file, { 0, 0, 0 }, { 1, 0, 0 }, ofUse(IgesUse::Construction));
  addLine(file, { 0, 1, 0 }, { 1, 1, 0 }, ofUse(IgesUse::Annotation));
  const auto model = readWritten(file);
  EXPECT_EQ(model->count(1), 1);
  EXPECT_EQ(leftOut(*model), "annotation (use flag 01)");
}

TEST(IgesStatus, curvesBesideFacesAreEdges)
{
  IgesWriter file;
  addSquare(file, { 0, 0, 0 }, {});
  addLine(file, { 5, 0, 0 }, { 6, 0, 0 });
  EXPECT_EQ(readWritten(file)->count(1), 5);
}

TEST(IgesStatus, membersOfAGroupStandForThemselves)
{
  for (const int form : { 1, 7, 14, 15 })
  {
    IgesWriter file;
    const int shown = addLine(file, { 0, 0, 0 }, { 1, 0, 0 });
    const int hidden = addLine(file, { 0, 1, 0 }, { 1, 1, 0 }, blanked());
    const int inner = file.add(402, igesValues(1, hidden), withForm(form));
    file.add(402, igesValues(2, shown, inner), withForm(form));
    const auto model = readWritten(file);
    EXPECT_EQ(model->count(1), 1);
    EXPECT_EQ(leftOut(*model), "blanked");
  }
}

TEST(IgesStatus, whatADrawingRefersToIsRead)
{
  IgesWriter file;
  const int line = addLine(file, { 0, 0, 0 }, { 1, 0, 0 });
  file.add(402, igesValues(1, 1, 0, line), withForm(3)); // views visible
  EXPECT_EQ(readWritten(file)->count(1), 1);
}

TEST(IgesStatus, aSubfigureIsReadWhereItIsPlaced)
{
  IgesWriter file;
  const int line = addLine(file, { 0, 0, 0 }, { 1, 0, 0 }, dependent());
  const int figure = file.add(308, igesValues(0, "figure", 1, line), ofUse(IgesUse::Definition));
  file.add(408, igesValues(figure, 0.0, 2.0, 0.0, 1.0));
  file.add(408, igesValues(figure, 0.0, 4.0, 0.0, 2.0));
  const auto model = readWritten(file);
  EXPECT_EQ(model->count(1), 2);
  EXPECT_NEAR(model->nearest({ 0, 0, 0 }).distance, 2, 1e-9);
  EXPECT_NEAR(model->nearest({ 3, 4, 0 }).distance, 1, 1e-9);
}

TEST(IgesStatus, aSubfigureIsTurnedWithItsTranslation)
{
  IgesWriter file;
  const int turn =
    file.add(124, igesValues(0.0, -1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0));
  const int line = addLine(file, { 0, 0, 0 }, { 1, 0, 0 }, dependent());
  const int inner = file.add(308, igesValues(0, "inner", 1, line), ofUse(IgesUse::Definition));
  const int placed = file.add(408, igesValues(inner, 1.0, 0.0, 0.0, 1.0), dependent());
  const int outer = file.add(308, igesValues(1, "outer", 1, placed), ofUse(IgesUse::Definition));
  file.add(408, igesValues(outer, 2.0, 0.0, 0.0, 1.0), moved(turn));
  const auto model = readWritten(file);
  EXPECT_EQ(model->count(1), 1);
  EXPECT_NEAR(model->nearest({ 0, 0, 0 }).distance, 3, 1e-9);
  EXPECT_NEAR(model->nearest({ 0, 6, 0 }).distance, 2, 1e-9);
}

struct LeftOutCase
{
  const char* name;
  void (*write)(IgesWriter& file);
  const char* reason;
};

void PrintTo(const LeftOutCase& tried, std::ostream* out)
{
  *out << tried.name;
}

class IgesForms : public testing::TestWithParam<LeftOutCase>
{
};

const std::vector<Point3> corners{ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };

INSTANTIATE_TEST_SUITE_P(LeftOut, IgesForms,
  testing::Values(
    LeftOutCase{ "Plane108_0",
      [](IgesWriter& f) { f.add(108, igesValues(0.0, 0.0, 1.0, 0.0, 0, 0.0, 0.0, 0.0, 0.0)); },
      "an unbounded plane" },
    LeftOutCase{ "Line110_1",
      [](IgesWriter& f) {
        addLine(f, { 0, 0, 0 }, { 1, 0, 0 }, withForm(1));
      },
      "an unbounded line" },
    LeftOutCase{ "Line110_2",
      [](IgesWriter& f) {
        addLine(f, { 0, 0, 0 }, { 1, 0, 0 }, withForm(2));
      },
      "an unbounded line" },
    LeftOutCase{ "Points106_1",
      [](IgesWriter& f) { f.add(106, igesValues(1, 2, 0.0, 1.0, 1.0, 2.0, 2.0), withForm(1)); },
      "a set of points" },
    LeftOutCase{ "Points106_2",
      [](IgesWriter& f) { f.add(106, igesValues(2, 3, corners), withForm(2)); },
      "a set of points" },
    LeftOutCase{ "Points106_3",
      [](IgesWriter& f) { f.add(106, igesValues(3, 3, corners, corners), withForm(3)); },
      "a set of points" },
    LeftOutCase{ "CentreLine106_20",
      [](IgesWriter& f) { f.add(106, igesValues(1, 2, 0.0, 1.0, 1.0, 2.0, 2.0), withForm(20)); },
      "annotation" },
    LeftOutCase{
      "Point116", [](IgesWriter& f) { f.add(116, igesValues(1.0, 2.0, 3.0, 0)); }, "a point" }),
  [](const auto& c) { return c.param.name; });

TEST_P(IgesForms, thatAreNoPartOfAModelAreListed)
{
  IgesWriter file;
  addLine(file, { 5, 0, 0 }, { 6, 0, 0 });
  GetParam().write(file);
  const auto model = readWritten(file);
  EXPECT_EQ(model->count(1), 1);
  EXPECT_TRUE(model->unread().empty());
  EXPECT_EQ(leftOut(*model), GetParam().reason);
}

TEST(IgesStatus, pointsAloneAreReadAsAPath)
{
  IgesWriter file;
  file.add(106, igesValues(2, 3, corners), withForm(2));
  EXPECT_EQ(readWritten(file)->count(1), 2);
}

class IgesUnread : public testing::TestWithParam<LeftOutCase>
{
};

INSTANTIATE_TEST_SUITE_P(Listed, IgesUnread,
  testing::Values(
    LeftOutCase{ "VaryingOffset130",
      [](IgesWriter& f)
      {
        const int line = addLine(f, { 0, 0, 0 }, { 1, 0, 0 }, dependent());
        f.add(130, igesValues(line, 2, 0, 0, 1, 1.0, 0.0, 2.0, 1.0, Point3{ 0, 0, 1 }, 0.0, 1.0));
      },
      "Offset" },
    LeftOutCase{
      "Sphere158", [](IgesWriter& f) { f.add(158, igesValues(1.0, 0.0, 0.0, 0.0)); }, "" }),
  [](const auto& c) { return c.param.name; });

TEST_P(IgesUnread, isListedBesideWhatIsRead)
{
  IgesWriter file;
  addLine(file, { 5, 0, 0 }, { 6, 0, 0 });
  GetParam().write(file);
  const auto model = readWritten(file);
  EXPECT_EQ(model->count(1), 1);
  ASSERT_EQ(model->unread().size(), 1u);
  EXPECT_NE(model->unread()[0].reason.find(GetParam().reason), std::string::npos)
    << model->unread()[0].reason;
  EXPECT_NE(model->unread()[0].reason, "");
}

} // namespace
