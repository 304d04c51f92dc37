// Marked cells whose longest edge is inside the mesh: what CutFacets adds.

#include "DataSets.h"
#include "FilterRun.h"
#include "MeshChecks.h"

#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <map>
#include <set>

namespace
{

using namespace cadrefine;
using Data = cadtest::FilterRun::Data;

Data refine(const cadtest::FilterRun& filters, vtkPointSet* measured, double threshold, bool cut)
{
  return filters.measure(filters.run<vtkRefineWithCAD>(measured,
                           [&](vtkRefineWithCAD* filter)
                           {
                             filter->SetMarkingArray("GeometricError");
                             filter->SetThreshold(threshold);
                             filter->SetCutFacets(cut);
                           }),
    1);
}

double error(vtkPointSet* data)
{
  return cadtest::fieldValue(data, "GlobalGeometricError");
}

void expectSound(vtkPointSet* data)
{
  const Mesh mesh = cadtest::toMesh(data);
  EXPECT_TRUE(cadtest::isValid(mesh));
  EXPECT_TRUE(cadtest::hasNoHangingVertex(mesh));
}

/// A side of a cell by its points, whatever their numbers.
using Side = std::set<Point3>;

template<std::size_t N, class Visit>
void visitSides(const Mesh& mesh, const Cells<N>& cells, const Visit& visit)
{
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    for (std::size_t left = 0; left < N; ++left)
    {
      std::vector<Index> side;
      for (std::size_t k = 0; k < N; ++k)
      {
        if (k != left)
        {
          side.push_back(cells[c][k]);
        }
      }
      visit(c, side, mesh);
    }
  }
}

template<std::size_t N>
std::map<Side, int> countSides(const Mesh& mesh, const Cells<N>& cells)
{
  std::map<Side, int> counts;
  visitSides(mesh, cells,
    [&](std::size_t, const std::vector<Index>& side, const Mesh&)
    {
      Side points;
      for (const Index v : side)
      {
        points.insert(mesh.points[v]);
      }
      ++counts[points];
    });
  return counts;
}

/// The outer sides of cells with an error above the threshold, all of whose points are on the CAD
/// and not on a wall (in one plane y = const).
template<std::size_t N>
std::set<Side> markedFacets(
  vtkPointSet* measured, const Mesh& mesh, const Cells<N>& cells, double threshold)
{
  vtkDataArray* errors = measured->GetCellData()->GetArray("GeometricError");
  vtkDataArray* dimensions = measured->GetPointData()->GetArray("CADDimension");
  const vtkIdType first = measured->GetNumberOfCells() - static_cast<vtkIdType>(cells.size());
  const auto counts = countSides(mesh, cells);
  std::set<Side> facets;
  visitSides(mesh, cells,
    [&](std::size_t c, const std::vector<Index>& side, const Mesh&)
    {
      const bool onCAD = std::all_of(
        side.begin(), side.end(), [&](Index v) { return dimensions->GetTuple1(v) >= 0; });
      const bool onWall =
        N == 4 && std::all_of(side.begin(), side.end(),
                    [&](Index v) { return mesh.points[v][1] == mesh.points[side[0]][1]; });
      Side points;
      for (const Index v : side)
      {
        points.insert(mesh.points[v]);
      }
      if (onCAD && !onWall && counts.at(points) == 1 &&
          errors->GetTuple1(first + static_cast<vtkIdType>(c)) > threshold)
      {
        facets.insert(points);
      }
    });
  return facets;
}

template<std::size_t N>
std::size_t countLeft(const std::set<Side>& facets, const Mesh& mesh, const Cells<N>& cells)
{
  const auto counts = countSides(mesh, cells);
  return static_cast<std::size_t>(std::count_if(
    facets.begin(), facets.end(), [&](const Side& facet) { return counts.count(facet) > 0; }));
}

/// The first longest edge step on the section: the cells' longest edges are inside.
TEST(CutFacets, cutsTheFacetsOfTheWing)
{
  constexpr double threshold = 1e-7;
  const cadtest::FilterRun filters(CADREFINE_DATA "/naca0012_sharp.igs");
  const Data before =
    filters.measure(filters.project(cadtest::readGrid(CADREFINE_DATA "/naca0012_coarse.vtu")), 1);
  const Mesh coarse = cadtest::toMesh(before);
  const auto facets = markedFacets(before, coarse, coarse.tetrahedra, threshold);
  ASSERT_GT(facets.size(), 20u);

  const Data without = refine(filters, before, threshold, false);
  const Data with = refine(filters, before, threshold, true);
  expectSound(with);
  const Mesh mesh = cadtest::toMesh(with);
  const Mesh plain = cadtest::toMesh(without);
  EXPECT_EQ(countLeft(facets, mesh, mesh.tetrahedra), 0u);
  EXPECT_EQ(countLeft(facets, plain, plain.tetrahedra), facets.size());
  EXPECT_NEAR(error(without), error(before), 1e-12) << "which is why the option is there";
  EXPECT_LT(error(with), 0.6 * error(before));
  for (const double part : { 0.0, 0.05 })
  {
    EXPECT_GT(
      filters.qualityPercentile(with, part), 0.9 * filters.qualityPercentile(without, part));
  }
}

TEST(CutFacets, cutsTheSegmentsOfThreeArcs)
{
  constexpr double threshold = 1e-5;
  const cadtest::FilterRun filters(CADREFINE_DATA "/three_arcs.igs");
  Data with =
    filters.measure(filters.project(cadtest::readGrid(CADREFINE_DATA "/three_arcs_coarse.vtu")), 1);
  for (int step = 0; step < 4; ++step)
  {
    const Data before = with;
    const Mesh coarse = cadtest::toMesh(before);
    const auto facets = markedFacets(before, coarse, coarse.triangles, threshold);
    ASSERT_EQ(facets.size(), 10u << step);
    with = refine(filters, before, threshold, true);
    expectSound(with);
    const Mesh mesh = cadtest::toMesh(with);
    EXPECT_EQ(countLeft(facets, mesh, mesh.triangles), 0u);
    EXPECT_NEAR(error(with), error(before) / 4, 0.05 * error(before));
  }
}

TEST(CutFacets, changesNothingWhereNoCellIsMarked)
{
  const cadtest::FilterRun filters(CADREFINE_DATA "/naca0012_sharp.igs");
  const Data before =
    filters.measure(filters.project(cadtest::readGrid(CADREFINE_DATA "/naca0012_coarse.vtu")), 1);
  EXPECT_TRUE(
    cadtest::areSame(refine(filters, before, 100, false), refine(filters, before, 100, true)));
}

} // namespace
