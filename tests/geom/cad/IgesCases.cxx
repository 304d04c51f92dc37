#include "IgesCases.h"

#include "TestFiles.h"

#include <cadrefine/cad/import/CADFile.h>
#include <cadrefine/cad/model/ModelDrawing.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace cadtest
{

using namespace cadrefine;

void PrintTo(const IgesCase& shown, std::ostream* stream)
{
  *stream << shown.name;
}

std::shared_ptr<const CADModel> readWritten(const IgesWriter& file)
{
  const TemporaryFolder folder;
  file.write(folder.file("written.igs"));
  return readCADFile(folder.file("written.igs"));
}

void expectCase(const CADModel& model, const IgesCase& expected)
{
  EXPECT_EQ(model.count(2), expected.faces);
  EXPECT_EQ(model.count(1), expected.edges);
  const double fine = 1e-7 * model.size();
  const ModelDrawing drawings = drawModel(model, 0.01 * model.size());
  for (const auto* ofDimension : { &drawings.edges, &drawings.faces })
  {
    for (const Tessellation& drawing : *ofDimension)
    {
      EXPECT_GE(drawing.points.size(), 2u);
      double off = 0, away = 0;
      for (const Point3& p : drawing.points)
      {
        off = std::max(off, std::abs(expected.off(p)));
        away = std::max(away, model.nearest(p).distance);
      }
      EXPECT_LT(off, fine) << (ofDimension == &drawings.edges ? "an edge" : "a face");
      EXPECT_LT(away, fine) << (ofDimension == &drawings.edges ? "an edge" : "a face");
    }
  }
  for (const IgesCase::Known& known : expected.known)
  {
    const ClosestPoint found = model.nearest(known.point);
    EXPECT_NEAR(found.distance, known.distance, fine)
      << known.point[0] << " " << known.point[1] << " " << known.point[2];
    EXPECT_NEAR(expected.off(found.point), 0, fine);
  }
}

IgesAttributes withForm(int form)
{
  IgesAttributes attributes;
  attributes.form = form;
  return attributes;
}

IgesAttributes dependent(int form)
{
  IgesAttributes attributes = withForm(form);
  attributes.subordinate = 1;
  return attributes;
}

int addLine(IgesWriter& file, const Point3& a, const Point3& b, const IgesAttributes& attributes)
{
  return file.add(110, igesValues(a, b), attributes);
}

int addArc(IgesWriter& file, double z, const std::vector<double>& centreStartEnd,
  const IgesAttributes& attributes)
{
  return file.add(100, igesValues(z, centreStartEnd), attributes);
}

int addBilinear(
  IgesWriter& file, const std::vector<Point3>& corners, const IgesAttributes& attributes)
{
  const std::vector<double> knots{ 0, 0, 1, 1 };
  const std::vector<double> weights(4, 1.0);
  return file.add(128,
    igesValues(1, 1, 1, 1, 0, 0, 1, 0, 0, knots, knots, weights, corners, 0.0, 1.0, 0.0, 1.0),
    attributes);
}

int addPolygon(IgesWriter& file, std::vector<Point3> points, const IgesAttributes& attributes)
{
  IgesAttributes spatial = attributes;
  spatial.form = 12;
  points.push_back(points.front());
  return file.add(106, igesValues(2, static_cast<int>(points.size()), points), spatial);
}

int addSquare(IgesWriter& file, const Point3& corner, const IgesAttributes& attributes)
{
  const auto at = [&](double x, double y) { return corner + Point3{ x, y, 0 }; };
  const int surface = addBilinear(file, { at(0, 0), at(1, 0), at(0, 1), at(1, 1) }, dependent());
  return file.add(144, igesValues(surface, 0, 0, 0), attributes);
}

} // namespace cadtest
