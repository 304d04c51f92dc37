// A face on a rational spline surface, as STEP and as BREP, with one of its numbers wrong. (IGES:
// BadIges.cxx.)

#include "BadFiles.h"

#include "ShapeText.h"

#include <BRepBuilderAPI_MakeFace.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Precision.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopoDS_Face.hxx>

namespace badcad
{
namespace
{

// Numbers that are nothing else in the file.
const std::string coordinate = "0.15625";
const std::string weight = "0.8125";
const std::string knot = "0.4375";

/// Of degree 3 with 5 columns along u, linear along v; height, weight and inner knot of its middle
/// are those above.
TopoDS_Face splineFace()
{
  constexpr int columns = 5;
  constexpr int rows = 2;
  TColgp_Array2OfPnt poles(1, columns, 1, rows);
  TColStd_Array2OfReal weights(1, columns, 1, rows);
  for (int i = 1; i <= columns; ++i)
  {
    for (int j = 1; j <= rows; ++j)
    {
      const bool middle = i == 3;
      poles.SetValue(i, j, gp_Pnt(i - 1, j - 1, middle ? std::stod(coordinate) : 0));
      weights.SetValue(i, j, middle ? std::stod(weight) : 1);
    }
  }
  TColStd_Array1OfReal knotsU(1, 3), knotsV(1, 2);
  TColStd_Array1OfInteger timesU(1, 3), timesV(1, 2);
  knotsU(1) = knotsV(1) = 0;
  knotsU(2) = std::stod(knot);
  knotsU(3) = knotsV(2) = 1;
  timesU(1) = timesU(3) = 4;
  timesU(2) = 1;
  timesV(1) = timesV(2) = 2;
  const Handle(Geom_Surface) surface =
    new Geom_BSplineSurface(poles, weights, knotsU, knotsV, timesU, timesV, 3, 1);
  return BRepBuilderAPI_MakeFace(surface, Precision::Confusion()).Face();
}

/// Those that both formats write alike.
void addBadNumbers(std::vector<BadFile>& files, const std::string& text, const std::string& format)
{
  std::vector<Change> changes;
  for (const char* number : { "nan", "inf", "1.E300", "-1.E300", "1.E999", "1.E-300", "x" })
  {
    changes.insert(changes.end(), { { coordinate, number }, { weight, number }, { knot, number } });
  }
  for (const char* number : { "0.", "-1.", "-1.E-9", "1.E-20", "1.E20" })
  {
    changes.push_back({ weight, number });
  }
  for (const char* number : { "1.5", "-1.", "0.", "1.", "1.E-16" }) // decreasing, repeated
  {
    changes.push_back({ knot, number });
  }
  addChanged(files, text, format, changes);
  addChangedAll(files, text, format, changes);
}

/// `shown` with each of `numbers` in place of its '@', for the header `sound`.
void addHeaders(std::vector<Change>& changes, const std::string& sound, const std::string& shown)
{
  for (const char* number : { "0", "-1", "2", "25", "26", "30", "60", "2000000000", "nan" })
  {
    std::string bad = shown;
    changes.push_back({ sound, bad.replace(bad.find('@'), 1, number) });
  }
}

} // namespace

std::vector<BadFile> badSplineFiles()
{
  std::vector<BadFile> files;
  const std::string step = textOf(splineFace(), ".step");
  addBadNumbers(files, step, ".step");
  std::vector<Change> inStep{ { "(#32,#33)", "()" }, { "(#32,#33)", "(#32)" },
    { "(#32,#33)", "(#32,#31)" }, { "(#32,#33)", "(#32,#99999)" }, { "(#32,#33)", "(#32,#13)" },
    { "(4,1,4),(2", "(4,4),(2" }, { "(4,1,4),(2", "(),(2" }, { "(0.,0.4375,1.)", "(0.,1.)" },
    { "(0.,0.4375,1.)", "()" }, { "(0.8125,0.8125)", "(0.8125)" }, { "(0.8125,0.8125)", "" } };
  addHeaders(inStep, "B_SPLINE_SURFACE(3,", "B_SPLINE_SURFACE(@,");
  addHeaders(inStep, "B_SPLINE_CURVE(3,", "B_SPLINE_CURVE(@,");
  addHeaders(inStep, "(4,1,4),(2", "(4,@,4),(2");
  addHeaders(inStep, "(4,1,4),(2", "(@,1,4),(2");
  addChanged(files, step, ".step", inStep);

  const std::string brep = textOf(splineFace(), ".brep");
  addBadNumbers(files, brep, ".brep");
  std::vector<Change> inBrep;
  const std::string surface = "9 0 1 0 0 3 1 5 2 3 2", curve = "7 1 0  3 5 3";
  for (const char* header : { "9 0 1 0 0 @ 1 5 2 3 2", "9 0 1 0 0 3 1 @ 2 3 2",
         "9 0 1 0 0 3 1 5 2 @ 2", "9 @ 1 0 0 3 1 5 2 3 2" })
  {
    addHeaders(inBrep, surface, header);
  }
  for (const char* header : { "7 1 0  @ 5 3", "7 1 0  3 @ 3", "7 1 0  3 5 @" })
  {
    addHeaders(inBrep, curve, header);
  }
  addHeaders(inBrep, "\n0.4375 1", "\n0.4375 @");
  addChanged(files, brep, ".brep", inBrep);
  return files;
}

} // namespace badcad
