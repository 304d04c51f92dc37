// Entities of IGES with closed forms, and the check of a model against them.
#pragma once

#include "IgesWriter.h"

#include <cadrefine/cad/model/CADModel.h>

#include <iosfwd>
#include <memory>
#include <vector>

namespace cadtest
{

/// What is known of the model that a file must give.
struct IgesCase
{
  const char* name;
  void (*write)(IgesWriter& file);
  int faces = 0;
  int edges = 0;
  /// Zero for the points of the shape and its carrier, else some distance from it.
  double (*off)(const cadrefine::Point3& p);
  struct Known
  {
    cadrefine::Point3 point;
    double distance;
  };
  std::vector<Known> known; ///< Distances from the trimmed model.
};

/// So that GoogleTest shows the name, not the bytes.
void PrintTo(const IgesCase& shown, std::ostream* stream);

std::shared_ptr<const cadrefine::CADModel> readWritten(const IgesWriter& file);

/// Counts, points spread over the model, and distances are as the case says.
void expectCase(const cadrefine::CADModel& model, const IgesCase& expected);

IgesAttributes withForm(int form);
/// A part of another entity: physically dependent.
IgesAttributes dependent(int form = 0);

/// Line (110) between two points.
int addLine(IgesWriter& file, const cadrefine::Point3& a, const cadrefine::Point3& b,
  const IgesAttributes& attributes = {});
/// Arc (100), counterclockwise in the plane at height z.
int addArc(IgesWriter& file, double z, const std::vector<double>& centreStartEnd,
  const IgesAttributes& attributes = {});
/// Bilinear surface (128) over (0, 1) x (0, 1) with corners at (0,0), (1,0), (0,1), (1,1).
int addBilinear(IgesWriter& file, const std::vector<cadrefine::Point3>& corners,
  const IgesAttributes& attributes = {});
/// Polygon (106, form 12), through all points and back to the first.
int addPolygon(
  IgesWriter& file, std::vector<cadrefine::Point3> points, const IgesAttributes& attributes = {});
/// The unit square in the plane at height z as a trimmed surface (144) without a loop.
int addSquare(IgesWriter& file, const cadrefine::Point3& corner, const IgesAttributes& attributes);

} // namespace cadtest
