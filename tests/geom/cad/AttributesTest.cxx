// Names and colours of the file reach the entities of the model, through sewing, healing and bytes.

#include "IgesCases.h"
#include "TestFiles.h"

#include <cadrefine/cad/import/CADFile.h>

#include <BRepPrimAPI_MakeBox.hxx>

#include <gtest/gtest.h>

#include <algorithm>

namespace
{

using namespace cadrefine;
using namespace cadtest;

using Colour = std::array<float, 3>;

IgesAttributes named(const std::string& label, int colour)
{
  IgesAttributes attributes;
  attributes.label = label;
  attributes.colour = colour;
  return attributes;
}

/// The face that holds a point.
EntityAttributes lookAt(const CADModel& model, const Point3& point)
{
  return model.attributes(model.nearest(point).entity);
}

/// Two unit squares that meet at x = 1, with an edge apart from them.
IgesWriter twoSquares()
{
  IgesWriter file;
  const int orange = file.add(314, igesValues(100.0, 50.0, 0.0, "orange"));
  const int name = file.add(406, igesValues(1, "Starboard wing"), withForm(15));
  addSquare(file, { 0, 0, 0 }, named("PORT", 2));
  IgesAttributes second = named("ignored", -orange);
  second.properties = { name };
  addSquare(file, { 1, 0, 0 }, second);
  addLine(file, { 0, 5, 0 }, { 1, 5, 0 }, named("AXIS", 4));
  return file;
}

void expectTwoSquares(const CADModel& model)
{
  ASSERT_EQ(model.count(2), 2);
  EXPECT_EQ(lookAt(model, { 0.5, 0.5, 0 }).name, "PORT");
  EXPECT_EQ(lookAt(model, { 0.5, 0.5, 0 }).colour, (Colour{ 1, 0, 0 }));
  EXPECT_EQ(lookAt(model, { 1.5, 0.5, 0 }).name, "Starboard wing");
  EXPECT_EQ(lookAt(model, { 1.5, 0.5, 0 }).colour, (Colour{ 1, 0.5, 0 }));
  EXPECT_EQ(lookAt(model, { 0.5, 5, 0 }).name, "AXIS");
  EXPECT_EQ(lookAt(model, { 0.5, 5, 0 }).colour, (Colour{ 0, 0, 1 }));
}

TEST(Looks, ofIgesSurviveSewingAndBytes)
{
  const auto model = readWritten(twoSquares());
  EXPECT_EQ(model->count(1), 8) << "the squares share an edge";
  expectTwoSquares(*model);
  expectTwoSquares(*CADModel::fromBytes(model->toBytes()));
}

TEST(Looks, areEmptyWhereTheFileHasNone)
{
  IgesWriter file;
  addSquare(file, { 0, 0, 0 }, {});
  const auto model = readWritten(file);
  EXPECT_EQ(model->attributes({ 2, 0 }).name, "");
  EXPECT_FALSE(model->attributes({ 2, 0 }).colour);
  EXPECT_FALSE(model->attributes({ 0, 0 }).colour);
}

std::size_t lineOf(const std::vector<std::string>& lines, const std::string& text, int which)
{
  std::size_t at = 0;
  for (; at < lines.size(); ++at)
  {
    if (lines[at].find(text) != std::string::npos && which-- == 0)
    {
      break;
    }
  }
  return at;
}

/// A box whose solid is red, and whose first face is named and green.
std::vector<std::string> colouredBox(const std::string& path)
{
  writeShape(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), path);
  auto lines = linesOf(path);
  std::string& face = lines[lineOf(lines, "ADVANCED_FACE('',", 0)];
  face.replace(face.find("''"), 2, "'Keel'");
  const std::string solid = lines[lineOf(lines, "MANIFOLD_SOLID_BREP", 0)];
  const std::string context = lines[lineOf(lines, "GEOMETRIC_REPRESENTATION_CONTEXT(3)", 0)];
  const auto number = [](const std::string& line) { return line.substr(0, line.find(' ')); };
  const std::string styles =
    "#900=COLOUR_RGB('',1.,0.,0.);#901=COLOUR_RGB('',0.,1.,0.);\n"
    "#910=FILL_AREA_STYLE_COLOUR('',#900);#911=FILL_AREA_STYLE_COLOUR('',#901);\n"
    "#920=FILL_AREA_STYLE('',(#910));#921=FILL_AREA_STYLE('',(#911));\n"
    "#930=SURFACE_STYLE_FILL_AREA(#920);#931=SURFACE_STYLE_FILL_AREA(#921);\n"
    "#940=SURFACE_SIDE_STYLE('',(#930));#941=SURFACE_SIDE_STYLE('',(#931));\n"
    "#950=SURFACE_STYLE_USAGE(.BOTH.,#940);#951=SURFACE_STYLE_USAGE(.BOTH.,#941);\n"
    "#960=PRESENTATION_STYLE_ASSIGNMENT((#950));#961=PRESENTATION_STYLE_ASSIGNMENT((#951));\n"
    "#970=STYLED_ITEM('',(#960)," +
    number(solid) + ");#971=STYLED_ITEM('',(#961)," + number(face) +
    ");\n#980=MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',(#970,#971)," +
    number(context) + ");";
  lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(lineOf(lines, "ENDSEC", 1)), styles);
  writeLines(path, lines);
  return lines;
}

TEST(Looks, ofStepFacesGoBeforeThoseOfTheSolid)
{
  const TemporaryFolder folder;
  colouredBox(folder.file("box.step"));
  const auto model = readCADFile(folder.file("box.step"));
  ASSERT_EQ(model->count(2), 6);
  int red = 0, green = 0;
  for (int face = 0; face < 6; ++face)
  {
    const EntityAttributes& look = model->attributes({ 2, face });
    ASSERT_TRUE(look.colour);
    red += *look.colour == Colour{ 1, 0, 0 } ? 1 : 0;
    green += *look.colour == Colour{ 0, 1, 0 } && look.name == "Keel" ? 1 : 0;
  }
  EXPECT_EQ(red, 5);
  EXPECT_EQ(green, 1);
}

} // namespace
