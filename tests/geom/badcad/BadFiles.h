// CAD files that are wrong in one way each, made by programs.
#pragma once

#include <string>
#include <vector>

namespace badcad
{

struct BadFile
{
  std::string name;      ///< What is wrong with it.
  std::string extension; ///< ".igs", ".step" or ".brep".
  std::string text;
};

/// Entities of IGES with bad splines, pointers, counts, loops and transformations.
std::vector<BadFile> badIgesFiles();

/// The same, as far as it makes sense, in the text of STEP and BREP files.
std::vector<BadFile> badStepFiles();
std::vector<BadFile> badBrepFiles();

/// A face on a spline surface with bad coordinates, weights, knots, degrees and counts, in STEP and
/// BREP.
std::vector<BadFile> badSplineFiles();

/// Random bytes, alone, in place of the second half of a sound file, and after it, in each format.
std::vector<BadFile> garbageFiles();

/// A sound ball in STEP, and in binary BREP.
BadFile soundStep();
BadFile soundBinaryBrep();

/// Shapes that are no models, in each of the formats that Open CASCADE can write them in.
std::vector<BadFile> badShapes();

/// A sphere at 1e300, on which Open CASCADE computes without end.
BadFile endlessBrep();

/// Files that take long: 10,000 patches in one place (the first), a loop of 20,000 corners, 500
/// subfigures in each other, and endlessBrep().
std::vector<BadFile> dearFiles();

/// `text` cut off at so many places.
std::vector<BadFile> cutAnywhere(const BadFile& sound, int places);

/// `text` cut off at the end of each of its lines, and within each.
std::vector<BadFile> cutFiles(const std::string& text, const std::string& extension);

} // namespace badcad
