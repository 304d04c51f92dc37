#include "pipeline/FitReport.h"

#include "pipeline/MeshSummary.h"

#include <cadrefine/cad/model/LengthUnit.h>

#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

namespace cadrefine
{
namespace
{

constexpr std::size_t mostLines = 10; ///< Most lines of points in a report.

struct UnitPair
{
  LengthUnit mesh;
  LengthUnit cad;
};

/// Size of the mesh's box as a part of that of the CAD's.
double ratioOf(const Fit& fit)
{
  return fit.meshBox.diagonal() / fit.cadBox.diagonal();
}

/// Units of mesh and CAD that the ratio suggests: the CAD's own, if it can be that one.
std::optional<UnitPair> likelyUnits(double ratio, const std::string& cadUnit)
{
  constexpr double near = 0.05; // coarse meshes of curved shapes are smaller than these
  const auto fits = [&](double mesh, double cad)
  { return mesh != cad && std::abs(ratio * mesh / cad - 1) < near; };
  std::optional<UnitPair> found;
  for (const LengthUnit& cad : usualUnits)
  {
    for (const LengthUnit& mesh : usualUnits)
    {
      const bool better = !found || (cad.name == cadUnit && found->cad.name != cadUnit);
      if (better && fits(unitLength(mesh.name), unitLength(cad.name)))
      {
        found = UnitPair{ mesh, cad };
      }
    }
  }
  return found;
}

/// What the boxes suggest of the units; empty where that is nothing.
std::string describeUnits(double ratio, const std::string& cadUnit)
{
  const auto likely = likelyUnits(ratio, cadUnit);
  if (!likely)
  {
    return {};
  }
  std::ostringstream text;
  text << "the mesh's bounding box is " << ratio
       << " times the size of the CAD's, as if the mesh were in " << likely->mesh.plural
       << " and the CAD in " << likely->cad.plural << ": ";
  if (cadUnit.empty() || likely->cad.name == cadUnit)
  {
    text << "set Unit of the CAD Reader to " << likely->mesh.name << " (driver: --cad-unit "
         << likely->mesh.name << "), or scale the mesh";
  }
  else
  {
    text << "scale the mesh, or correct the unit in the CAD file (" << cadUnit << ")";
  }
  return text.str();
}

std::string percent(double share)
{
  std::ostringstream text;
  text.precision(3);
  text << 100 * share << "%";
  return text.str();
}

std::ostream& operator<<(std::ostream& out, const Point3& p)
{
  return out << "(" << p[0] << ", " << p[1] << ", " << p[2] << ")";
}

std::string describeBoxes(const Fit& fit, const std::string& cadUnit)
{
  std::ostringstream text;
  text << "box of the mesh " << fit.meshBox.low << " to " << fit.meshBox.high << ", of the CAD "
       << fit.cadBox.low << " to " << fit.cadBox.high << (cadUnit.empty() ? "" : " ") << cadUnit;
  return text.str();
}

std::string describeShares(const Fit& fit)
{
  return percent(fit.boundaryOnCAD) + " of the mesh's boundary in the CAD's box (" +
         percent(fit.boundaryInBox) + " of all) is on the CAD" +
         (fit.cadCovered ? ", " + percent(*fit.cadCovered) + " of the CAD is covered" : "");
}

/// Says that the mesh has the CAD's box, but in another place; empty where it has not.
std::string describeShift(const Fit& fit)
{
  constexpr double least = 1e-5; // of the size
  constexpr double alike = 1e-2;
  constexpr double rounding = 1e-9;
  Vector3 low = fit.meshBox.low - fit.cadBox.low;
  const Vector3 high = fit.meshBox.high - fit.cadBox.high;
  if (norm(low) <= least * fit.cadBox.diagonal() || distance(low, high) > alike * norm(low))
  {
    return {};
  }
  for (double& coordinate : low)
  {
    coordinate = std::abs(coordinate) <= rounding * norm(low) ? 0 : coordinate;
  }
  std::ostringstream text;
  text << "the mesh's bounding box has the size of the CAD's, but is shifted by " << low
       << ": move the mesh or the CAD";
  return text.str();
}

/// Adds an array with these rows of components; none where there are no rows.
void addRows(vtkFieldData* data, const char* name, int components, const std::vector<double>& rows)
{
  if (rows.empty())
  {
    return;
  }
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  for (const double value : rows)
  {
    array->InsertNextValue(value);
  }
  data->AddArray(array);
}

/// The bounds of a box, as VTK orders them.
std::vector<double> boundsOf(const BoundingBox& box)
{
  const auto& [low, high] = box;
  return { low[0], high[0], low[1], high[1], low[2], high[2] };
}

std::vector<double> rowsOf(const std::vector<Point3>& points)
{
  std::vector<double> rows;
  for (const Point3& point : points)
  {
    rows.insert(rows.end(), point.begin(), point.end());
  }
  return rows;
}

} // namespace

std::string describeFit(const Fit& fit, const std::string& cadUnit)
{
  std::ostringstream text;
  text << describeBoxes(fit, cadUnit) << "\n" << describeShares(fit);
  text << "\nvertices off the CAD: " << fit.verticesOffCAD;
  for (const OffPoint& vertex : fit.farthest)
  {
    text << "\n  " << vertex.point << ", off by " << vertex.distance;
  }
  if (fit.bridgingFacets > 0)
  {
    text
      << "\nfacets off the CAD though all their vertices are on it, as over a hole or a ridge of "
         "the CAD that the mesh does not resolve: "
      << fit.bridgingFacets;
  }
  for (const Point3& centroid : fit.bridges)
  {
    text << "\n  " << centroid;
  }
  text << "\nvertices in conflict (CADConflict is 1): " << fit.conflictCount;
  for (std::size_t i = 0; i < std::min(fit.conflicts.size(), mostLines); ++i)
  {
    text << "\n  " << fit.conflicts[i];
  }
  return text.str();
}

std::string warningOfMisfit(const Fit& fit, const std::string& cadUnit, bool isWhole)
{
  constexpr double half = 0.5;
  constexpr double most = 0.65; // half a ball on a plane of symmetry, of chords; of a box a corner
  constexpr double little = 0.2;
  constexpr double nearlyAll = 0.9; // a box in another unit may share half of its sides
  constexpr double piece = 0.02;    // of the CAD; a cone fits one in any unit, but then less
  std::string shift = describeShift(fit);
  if (fit.wasOnCurved >= half && fit.cadCovered.value_or(0) >= piece)
  {
    return shift;
  }
  const bool fits = (fit.boundaryOnCAD >= half && fit.cadCovered.value_or(0) >= most) ||
                    fit.boundaryOnCAD * fit.boundaryInBox >= nearlyAll;
  std::string cause = fits || !shift.empty() ? shift : describeUnits(ratioOf(fit), cadUnit);
  const bool isElsewhere =
    fit.boundaryOnCAD * fit.boundaryInBox < half && fit.cadCovered.value_or(1) < little;
  if (!isWhole || (fit.boundaryOnCAD >= half && !isElsewhere))
  {
    return cause;
  }
  return describeShares(fit) + "; " +
         (cause.empty()
             ? "check that the mesh and the CAD have the same position and unit of length (" +
                 describeBoxes(fit, cadUnit) +
                 "; Unit of the CAD Reader, driver: --cad-unit, converts the CAD)"
             : cause);
}

std::string warningOfStrays(const Fit& fit)
{
  if (fit.strays == 0)
  {
    return {};
  }
  std::ostringstream text;
  text << "vertices moved onto the CAD where nearly all others lay on it already: " << fit.strays
       << ", the farthest by " << fit.farthestStray.distance << " to " << fit.farthestStray.point
       << "; if a wall that is not in the CAD meets it there, leave that out by Region or Faces";
  return text.str();
}

void removeFit(vtkFieldData* from)
{
  for (const char* name :
    { "CADCovered", "FarthestVertices", "BridgingFacetCentroids", "ConflictPoints" })
  {
    from->RemoveArray(name);
  }
}

void writeFit(vtkFieldData* data, const Fit& fit)
{
  addRows(data, "MeshBox", 1, boundsOf(fit.meshBox));
  addRows(data, "CADBox", 1, boundsOf(fit.cadBox));
  setFieldValue(data, "BoundaryOnCAD", fit.boundaryOnCAD);
  setFieldValue(data, "BoundaryInBox", fit.boundaryInBox);
  if (fit.cadCovered)
  {
    setFieldValue(data, "CADCovered", *fit.cadCovered);
  }
  std::vector<double> rows;
  for (const auto& [point, distance] : fit.farthest)
  {
    rows.insert(rows.end(), { point[0], point[1], point[2], distance });
  }
  addRows(data, "FarthestVertices", 4, rows);
  addRows(data, "BridgingFacetCentroids", 3, rowsOf(fit.bridges));
  addRows(data, "ConflictPoints", 3, rowsOf(fit.conflicts));
  setFieldValue(data, "VerticesOffCAD", fit.verticesOffCAD);
  setFieldValue(data, "BridgingFacets", fit.bridgingFacets);
  setFieldValue(data, "ClassificationConflicts", fit.conflictCount);
}

} // namespace cadrefine
