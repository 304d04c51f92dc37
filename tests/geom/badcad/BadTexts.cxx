// Text of STEP and BREP files with one thing changed.

#include "BadFiles.h"

#include "Mutation.h"
#include "ShapeText.h"

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>

namespace badcad
{

std::vector<BadFile> badStepFiles()
{
  std::vector<BadFile> files;
  const std::string text = textOf(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), ".step");
  addChanged(files, text, ".step",
    { { "CARTESIAN_POINT('',(0.,0.,0.))", "CARTESIAN_POINT('',(1.E300,0.,0.))" },
      { "CARTESIAN_POINT('',(0.,0.,0.))", "CARTESIAN_POINT('',(1.E999,0.,0.))" },
      { "CARTESIAN_POINT('',(0.,0.,0.))", "CARTESIAN_POINT('',(nan,0.,0.))" },
      { "CARTESIAN_POINT('',(0.,0.,0.))", "CARTESIAN_POINT('',())" },
      { "CARTESIAN_POINT('',(0.,0.,0.))", "CARTESIAN_POINT('',(0.))" },
      { "CARTESIAN_POINT('',(0.,0.,0.))", "CARTESIAN_POINT('',$)" },
      { "CARTESIAN_POINT('',(0.,0.,0.))", "DIRECTION('',(0.,0.,0.))" },
      { "DIRECTION('',(1.,0.,", "DIRECTION('',(0.,0.," },
      { "DIRECTION('',(1.,0.,", "DIRECTION('',(1.E300,1.E300," },
      { "VECTOR('',#", "VECTOR('',#99999999" }, { "LINE('',#", "LINE('',#1" },
      { "EDGE_CURVE('',#", "EDGE_CURVE('',#1" }, { "PLANE('',#", "PLANE('',#1" },
      { "EDGE_LOOP('',(", "EDGE_LOOP('',(#1," }, { "FACE_BOUND('',#", "FACE_BOUND('',#1" },
      { "ADVANCED_FACE('',(", "ADVANCED_FACE('',(#1," }, { "ADVANCED_FACE('',(", "PLANE('',(" },
      { "CLOSED_SHELL('',(", "CLOSED_SHELL('',(#15,#15," }, { "ENDSEC;", "" }, { "DATA;", "" },
      { "HEADER;", "" }, { "#15 =", "#16 =" }, { "#15 =", "#-15 =" }, { "#15 =", "#99999999999 =" },
      { "SI_UNIT(", "SI_UNIT($," }, { "FILE_SCHEMA", "FILE_SCHEME" } });
  return files;
}

BadFile endlessBrep()
{
  std::vector<BadFile> files;
  addChanged(files, textOf(BRepPrimAPI_MakeSphere(1).Shape(), ".brep"), ".brep",
    { { "Surfaces 1\n4 0 0 0", "Surfaces 1\n4 1e300 0 0" } });
  return files.at(0);
}

std::vector<BadFile> badBrepFiles()
{
  std::vector<BadFile> files;
  const std::string text = textOf(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), ".brep");
  // Both went through to the mesher and to the search, and killed the process that used the model.
  addChanged(files, text, ".brep",
    { { "Ve\n1e-07\n0 ", "Ve\n1e-07\nnan " }, { "Ve\n1e-07\n0 ", "Ve\n1e-07\n1e200 " } });
  addChanged(files, textOf(BRepPrimAPI_MakeCylinder(1, 2).Shape(), ".brep"), ".brep",
    { { " 0 6.28318530717959", " 0 185707963267949" }, { " 0 6.28318530717959", " 0 1e300" } });
  const std::string ball = textOf(BRepPrimAPI_MakeSphere(1).Shape(), ".brep");
  for (const std::string section : { "Locations ", "Curve2ds ", "Curves ", "Polygon3D ",
         "PolygonOnTriangulations ", "Surfaces ", "Triangulations ", "\nTShapes " })
  {
    addChanged(files, text, ".brep",
      { { section, section + "9" }, { section, section + "-" }, { section, "" },
        { section, section + "1000000000" } });
  }
  addChanged(files, ball, ".brep",
    { { " 1\nTriangulations", " -1\nTriangulations" },
      { " 1\nTriangulations", " 0\nTriangulations" },
      { " 1\nTriangulations", " nan\nTriangulations" }, { "Surfaces 1\n4", "Surfaces 1\n99" },
      { "Surfaces 1\n4 0 0 0", "Surfaces 1\n4 nan 0 0" },
      { "Surfaces 1\n4 0 0 0 0 0 1", "Surfaces 1\n4 0 0 0 0 0 0" }, { "6.28", "1e300" },
      { "6.28", "-6.28" }, { "6.28", "nan" }, { "1.57", "99.57" }, { "1e-07", "1e300" },
      { "1e-07", "-1" }, { "1e-07", "nan" }, { "+2 0", "+999 0" }, { "+2 0", "+1 0" },
      { "-9 0", "-0 0" }, { "Ve\n", "So\n" }, { "Ed\n", "Ve\n" }, { "Fa\n", "Ed\n" } });
  return files;
}

BadFile soundStep()
{
  return { "a ball", ".step", textOf(BRepPrimAPI_MakeSphere(1).Shape(), ".step") };
}

BadFile soundBinaryBrep()
{
  return { "a ball", ".brep", binaryTextOf(BRepPrimAPI_MakeSphere(1).Shape()) };
}

std::vector<BadFile> garbageFiles()
{
  constexpr std::size_t size = 100000;
  const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(1).Shape();
  std::vector<BadFile> files;
  for (const BadFile& sound : { BadFile{ "", ".igs", textOf(ball, ".igs") }, soundStep(),
         BadFile{ "", ".brep", textOf(ball, ".brep") }, soundBinaryBrep() })
  {
    const std::string noise = garbage(size, files.size());
    const std::string half = sound.text.substr(0, sound.text.size() / 2);
    files.push_back({ "random bytes", sound.extension, noise });
    files.push_back({ "random bytes after half a file", sound.extension, half + noise });
    files.push_back({ "random bytes after a whole file", sound.extension, sound.text + noise });
  }
  return files;
}

} // namespace badcad
