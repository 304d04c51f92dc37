#include "BadFiles.h"

#include "IgesCases.h"
#include "IgesWriter.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace badcad
{
namespace
{

using cadrefine::Point3;
using cadtest::dependent;
using cadtest::IgesAttributes;
using cadtest::igesValues;
using cadtest::IgesValues;
using cadtest::IgesWriter;
using cadtest::withForm;

using Loop = std::vector<Point3>;

BadFile made(const std::string& name, const IgesWriter& file)
{
  std::string text;
  for (const std::string& line : file.lines())
  {
    text += line + "\n";
  }
  return { name, ".igs", text };
}

/// A flat spline surface (128) over the unit square, of degree 1 along v.
struct Patch
{
  int degree;
  IgesValues knots, weights, points;

  Patch(int degreeU, const std::vector<double>& knotsU) : degree(degreeU), knots(igesValues(knotsU))
  {
    for (const double v : { 0.0, 1.0 })
    {
      for (int i = 0; i < columns(); ++i)
      {
        cadtest::appendTo(weights, 1.0);
        cadtest::appendTo(points, static_cast<double>(i) / std::max(1, columns() - 1), v, 0.0);
      }
    }
  }

  int columns() const { return static_cast<int>(knots.size()) - degree - 1; }

  IgesValues values() const
  {
    IgesValues all = igesValues(columns() - 1, 1, degree, 1, 0, 0, 1, 0, 0);
    for (const IgesValues& part :
      { knots, igesValues(0., 0., 1., 1.), weights, points, igesValues(0., 1., 0., 1.) })
    {
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  }
};

Patch bezier(int degree)
{
  std::vector<double> knots(2 * static_cast<std::size_t>(degree) + 2, 1.0);
  std::fill_n(knots.begin(), degree + 1, 0.0);
  return { degree, knots };
}

/// The patch alone, and beside a sound square, which must not be lost with it.
void addPatch(std::vector<BadFile>& files, const std::string& name, const Patch& patch)
{
  IgesWriter alone, beside;
  alone.add(128, patch.values());
  beside.add(128, patch.values());
  cadtest::addSquare(beside, { 3, 0, 0 }, {});
  files.push_back(made(name, alone));
  files.push_back(made(name + ", and a sound face", beside));
}

void addBadNumbers(std::vector<BadFile>& files)
{
  for (const char* number : { "nan", "NAN", "inf", "1e300", "-1e300", "1e999", "1e40", "1e-300",
         "3Habc", "", "1.5.2", "--1", "0x10", "1D2D3" })
  {
    const std::string name = std::string("'") + number + "' as ";
    Patch point = bezier(3), weight = bezier(3), knot = bezier(3);
    point.points[4] = number;
    weight.weights[2] = number;
    knot.knots[3] = number;
    addPatch(files, name + "a coordinate", point);
    addPatch(files, name + "a weight", weight);
    addPatch(files, name + "a knot", knot);
    Patch all = bezier(3);
    std::fill(all.points.begin(), all.points.end(), number);
    addPatch(files, name + "all coordinates", all);
  }
  for (const char* weight : { "0.", "-1.", "-1e-9", "1e-20", "1e20" })
  {
    Patch one = bezier(3), all = bezier(3);
    one.weights[1] = weight;
    std::fill(all.weights.begin(), all.weights.end(), weight);
    addPatch(files, std::string("a weight of ") + weight, one);
    addPatch(files, std::string("all weights ") + weight, all);
  }
}

void addBadKnots(std::vector<BadFile>& files)
{
  addPatch(files, "decreasing knots", { 2, { 0, 0, 0, 0.7, 0.3, 1, 1, 1 } });
  addPatch(files, "all knots decreasing", { 2, { 1, 1, 1, 0.5, 0, 0, 0 } });
  addPatch(files, "all knots equal", { 2, { 0, 0, 0, 0, 0, 0 } });
  addPatch(files, "an inner knot as often as the order", { 2, { 0, 0, 0, .5, .5, .5, 1, 1, 1 } });
  addPatch(files, "an inner knot too often", { 2, { 0, 0, 0, .5, .5, .5, .5, .5, 1, 1, 1 } });
  addPatch(files, "an end knot too often", { 2, { 0, 0, 0, 0, 0, 0, 1, 1, 1 } });
  addPatch(files, "knots 1e-16 apart", { 2, { 0, 0, 0, 1e-16, 2e-16, 1, 1, 1 } });
  addPatch(files, "knots over 1e-30", { 2, { 0, 0, 0, 5e-31, 1e-30, 1e-30, 1e-30 } });
  addPatch(files, "knots up to 1e30", { 2, { 0, 0, 0, 5, 1e30, 1e30, 1e30 } });
  addPatch(files, "no end knot repeated", { 2, { 0, 1, 2, 3, 4, 5, 6 } });
  for (const int degree : { 0, 25, 26, 30, 60 })
  {
    addPatch(files, "degree " + std::to_string(degree), bezier(degree));
  }
}

/// Each number of a header (counts and degrees) wrong in turn, the rest as it should be.
void addBadCounts(std::vector<BadFile>& files)
{
  for (const char* count : { "0", "-1", "1", "5", "30", "1000", "10000000", "2147483647",
         "99999999999999999999", "", "1.5" })
  {
    for (std::size_t place = 0; place < 4; ++place)
    {
      IgesWriter file;
      IgesValues values = bezier(3).values();
      values[place] = count;
      file.add(128, values);
      cadtest::addSquare(file, { 3, 0, 0 }, {});
      files.push_back(
        made("'" + std::string(count) + "' as number " + std::to_string(place), file));
    }
    IgesWriter polygon, composite;
    IgesValues points = igesValues(2, 3, Loop{ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 } });
    points[1] = count;
    polygon.add(106, points, withForm(12));
    cadtest::addLine(composite, { 0, 0, 0 }, { 1, 0, 0 });
    IgesValues parts = igesValues(1, 1);
    parts[0] = count;
    composite.add(102, parts);
    files.push_back(made("'" + std::string(count) + "' points in a path", polygon));
    files.push_back(made("'" + std::string(count) + "' parts of a curve", composite));
  }
}

/// What type 142 and 144 say of a face over the unit square.
int addTrimmed(IgesWriter& file, const std::vector<Loop>& loops)
{
  const int surface =
    cadtest::addBilinear(file, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } }, dependent());
  std::vector<int> boundaries;
  for (const Loop& loop : loops)
  {
    const IgesValues points = igesValues(2, static_cast<int>(loop.size()), loop);
    const int inPlane = file.add(106, points, dependent(12));
    const int inSpace = file.add(106, points, dependent(12));
    boundaries.push_back(file.add(142, igesValues(0, surface, inPlane, inSpace, 1), dependent()));
  }
  const int outer = boundaries.empty() ? 0 : boundaries.front();
  const std::vector<int> inner(boundaries.begin() + (boundaries.empty() ? 0 : 1), boundaries.end());
  return file.add(144, igesValues(surface, 1, static_cast<int>(inner.size()), outer, inner));
}

Loop rectangle(double x0, double x1, double y0, double y1)
{
  return { { x0, y0, 0 }, { x1, y0, 0 }, { x1, y1, 0 }, { x0, y1, 0 }, { x0, y0, 0 } };
}

void addBadLoops(std::vector<BadFile>& files)
{
  const Loop outer = rectangle(.1, .9, .1, .9);
  const std::vector<std::pair<const char*, std::vector<Loop>>> cases{
    { "a face whose outer loop is missing", {} },
    { "a loop that crosses itself",
      { { { .2, .2, 0 }, { .8, .8, 0 }, { .8, .2, 0 }, { .2, .8, 0 }, { .2, .2, 0 } } } },
    { "an open loop", { { { .2, .2, 0 }, { .8, .2, 0 }, { .8, .8, 0 } } } },
    { "a loop outside of the surface", { rectangle(2, 3, 2, 3) } },
    { "a loop far outside of the surface", { rectangle(2e9, 3e9, 2, 3) } },
    { "a loop half outside of the surface", { rectangle(.5, 1.5, .5, 1.5) } },
    { "a loop without area", { { { .2, .2, 0 }, { .8, .2, 0 }, { .2, .2, 0 } } } },
    { "a loop of one point", { { { .2, .2, 0 }, { .2, .2, 0 }, { .2, .2, 0 } } } },
    { "a loop of size 1e-12", { rectangle(.5, .5 + 1e-12, .5, .5 + 1e-12) } },
    { "an edge of length zero",
      { { { .2, .2, 0 }, { .8, .2, 0 }, { .8, .2, 0 }, { .8, .8, 0 }, { .2, .2, 0 } } } },
    { "a loop that runs round twice",
      { { { .2, .2, 0 }, { .8, .2, 0 }, { .8, .8, 0 }, { .2, .2, 0 }, { .8, .2, 0 }, { .8, .8, 0 },
        { .2, .2, 0 } } } },
    { "an inner loop across the outer one", { outer, rectangle(.5, .95, .5, .95) } },
    { "an inner loop outside of the outer one", { outer, rectangle(2, 3, 2, 3) } },
    { "an inner loop that is the outer one", { outer, outer } },
    { "two inner loops that cross",
      { outer, rectangle(.2, .6, .2, .6), rectangle(.4, .8, .4, .8) } },
    { "loops turned inside out", { rectangle(.4, .6, .4, .6), outer } }
  };
  for (const auto& [name, loops] : cases)
  {
    IgesWriter file;
    addTrimmed(file, loops);
    files.push_back(made(name, file));
  }
}

void addBadPointers(std::vector<BadFile>& files)
{
  const auto add = [&](const std::string& name, const std::function<void(IgesWriter&)>& write)
  {
    IgesWriter file;
    cadtest::addSquare(file, { 3, 0, 0 }, {}); // entries 1 and 3
    write(file);
    files.push_back(made(name, file));
  };
  for (const int pointer : { 0, -1, 2, 3, 5, 7, 999, 9999999, -9999999 })
  {
    const std::string to = " points to " + std::to_string(pointer);
    add("a trimmed surface" + to,
      [=](IgesWriter& file) { file.add(144, igesValues(pointer, 0, 0, 0)); });
    add("a loop" + to,
      [=](IgesWriter& file)
      {
        file.add(142, igesValues(0, 1, pointer, pointer, 1));
        file.add(144, igesValues(1, 1, 0, 5));
      });
    add("a composite curve" + to,
      [=](IgesWriter& file) { file.add(102, igesValues(2, pointer, pointer)); });
    add("a surface of revolution" + to,
      [=](IgesWriter& file) { file.add(120, igesValues(pointer, pointer, 0., 6.)); });
    add("an offset surface" + to,
      [=](IgesWriter& file) { file.add(140, igesValues(0., 0., 1., 0.1, pointer)); });
    add("a subfigure" + to,
      [=](IgesWriter& file) { file.add(408, igesValues(pointer, 0., 0., 0., 1.)); });
    add("a subfigure's definition" + to,
      [=](IgesWriter& file)
      {
        file.add(308, igesValues(0, "name", 1, pointer));
        file.add(408, igesValues(5, 0., 0., 0., 1.));
      });
    add("a group" + to,
      [=](IgesWriter& file) { file.add(402, igesValues(1, pointer), withForm(7)); });
    add("a solid" + to, [=](IgesWriter& file) { file.add(186, igesValues(pointer, 1, 0)); });
    add("a shell" + to,
      [=](IgesWriter& file) { file.add(514, igesValues(1, pointer, 1), withForm(1)); });
    add("a transformation" + to,
      [=](IgesWriter& file)
      {
        IgesAttributes placed;
        placed.transformation = pointer;
        cadtest::addLine(file, { 0, 0, 0 }, { 1, 0, 0 }, placed);
      });
  }
}

/// A square behind `length` transformations, each with the next; the last one with `end`.
BadFile chain(const std::string& name, int length, const IgesValues& matrix, int end)
{
  IgesWriter file;
  for (int i = 0; i < length; ++i)
  {
    IgesAttributes next;
    next.transformation = i + 1 < length ? 2 * i + 3 : end;
    file.add(124, matrix, next);
  }
  IgesAttributes placed;
  placed.transformation = 1;
  cadtest::addSquare(file, { 0, 0, 0 }, placed);
  return made(name, file);
}

void addChains(std::vector<BadFile>& files)
{
  const IgesValues move = igesValues(1., 0., 0., .01, 0., 1., 0., 0., 0., 0., 1., 0.);
  const IgesValues grow = igesValues(2., 0., 0., 0., 0., 2., 0., 0., 0., 0., 2., 0.);
  const IgesValues flatten = igesValues(1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 0., 0.);
  for (const int length : { 1, 500, 5000 })
  {
    const std::string many = std::to_string(length) + " transformations ";
    files.push_back(chain(many + "that move", length, move, 0));
    files.push_back(chain(many + "that double", length, grow, 0));
    files.push_back(chain(many + "that flatten", length, flatten, 0));
    files.push_back(chain(many + "in a circle", length, move, 1));
  }
}

BadFile nestedSubfigures()
{
  IgesWriter nested;
  cadtest::addSquare(nested, { 0, 0, 0 }, {});
  for (int i = 0; i < 500; ++i)
  {
    const int last = 4 * i + 3;
    nested.add(308, igesValues(i, "figure", 1, last));
    nested.add(408, igesValues(last + 2, 0., 0., 0.01, 1.));
  }
  return made("500 subfigures in each other", nested);
}

} // namespace

std::vector<BadFile> badIgesFiles()
{
  std::vector<BadFile> files;
  addBadNumbers(files);
  addBadKnots(files);
  addBadCounts(files);
  addBadLoops(files);
  addBadPointers(files);
  addChains(files);
  return files;
}

std::vector<BadFile> dearFiles()
{
  constexpr int patches = 10000;
  constexpr int corners = 20000;
  IgesWriter coincident, comb;
  for (int i = 0; i < patches; ++i)
  {
    cadtest::addSquare(coincident, { 0, 0, 0 }, {});
  }
  Loop loop;
  for (int i = 0; i < corners; ++i)
  {
    const double x = .1 + .8 * i / corners;
    loop.push_back({ x, i % 2 == 0 ? .3 : .7, 0 });
  }
  loop.insert(loop.end(), { { .9, .1, 0 }, { .1, .1, 0 }, loop.front() });
  addTrimmed(comb, { loop });
  return { made("10,000 patches in one place", coincident), made("a loop of 20,000 corners", comb),
    nestedSubfigures(), endlessBrep() };
}

std::vector<BadFile> cutAnywhere(const BadFile& sound, int places)
{
  std::vector<BadFile> files;
  for (int i = 0; i < places; ++i)
  {
    const std::size_t size = sound.text.size() * static_cast<std::size_t>(i) / places;
    files.push_back({ "cut after " + std::to_string(size) + " bytes", sound.extension,
      sound.text.substr(0, size) });
  }
  return files;
}

std::vector<BadFile> cutFiles(const std::string& text, const std::string& extension)
{
  std::vector<BadFile> files;
  int line = 1;
  for (std::size_t from = 0; from < text.size(); ++line)
  {
    const std::size_t end = std::min(text.find('\n', from), text.size() - 1) + 1;
    const std::string after = "cut after line " + std::to_string(line);
    if (end < text.size())
    {
      files.push_back({ after, extension, text.substr(0, end) });
    }
    files.push_back({ "cut within line " + std::to_string(line), extension,
      text.substr(0, from + (end - from) / 2) });
    from = end;
  }
  return files;
}

} // namespace badcad
