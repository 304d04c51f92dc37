// What is wrong with hexahedra, wedges, pyramids and quadrilaterals: one error on all ranks, or
// work that does not mind.

#include "BadMesh.h"
#include "DataSets.h"
#include "MeshChecks.h"
#include "MixedMeshes.h"

#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <string>

namespace cadrefine
{

namespace
{

/// Of all shapes, near the sphere of radius 2.
Mesh mixedBall()
{
  return cadtest::randomlyMixedMesh(cadtest::hexahedralBallMesh(2, 0.02, 1, { 0.6, 1 }), 4);
}

std::array<Index, 6> turned(const std::array<Index, 6>& w)
{
  return { w[3], w[4], w[5], w[0], w[1], w[2] };
}

class BadMixedCells : public BadMesh
{
protected:
  Grid gridOnLastRank(const Mesh& mesh) const
  {
    return isLast() ? cadtest::toGrid(mesh) : Grid::New();
  }

  /// The mixed ball on the last rank, with one more cell.
  Grid withCell(int type, const std::vector<vtkIdType>& points) const
  {
    Grid grid = gridOnLastRank(mixedBall());
    if (isLast())
    {
      grid->InsertNextCell(type, static_cast<vtkIdType>(points.size()), points.data());
    }
    return grid;
  }

  /// Mesh Validity finds so many invalid cells, Project Onto CAD and Adapt To CAD work.
  void expectInvalid(vtkPointSet* piece, double count) const
  {
    const auto filter = allFilters()[2];
    const cadtest::Outcome outcome = filter.attempt(filters, piece);
    EXPECT_TRUE(outcome.succeeded);
    EXPECT_EQ(cadtest::fieldValue(outcome.pointSet(), "InvalidCells"), count);
    auto others = filtersOfRawMeshes();
    others.erase(
      exchange.size() > 1 ? others.begin() + 1 : others.end(), others.end()); // cells move
    for (const NamedFilter& other : others)
    {
      SCOPED_TRACE(other.name);
      const cadtest::Outcome result = other.attempt(filters, piece);
      EXPECT_TRUE(result.succeeded) << testing::PrintToString(result.errors);
    }
  }
};

TEST_F(BadMixedCells, nameAPointTwice)
{
  const std::string reason = "has repeated or coincident points";
  expectErrors(allFilters(), withCell(VTK_HEXAHEDRON, { 0, 1, 2, 3, 4, 5, 6, 0 }), reason);
  expectErrors(allFilters(), withCell(VTK_WEDGE, { 0, 1, 2, 3, 4, 3 }), reason);
  expectErrors(allFilters(), withCell(VTK_PYRAMID, { 0, 1, 2, 1, 4 }), reason);
  expectErrors(allFilters(), withCell(VTK_QUAD, { 0, 1, 0, 3 }), reason);
  expectErrors(allFilters(), withCell(VTK_VOXEL, { 0, 1, 2, 3, 4, 5, 6, 0 }), reason);
}

TEST_F(BadMixedCells, haveTooFewOrTooManyPoints)
{
  expectErrors(
    allFilters(), withCell(VTK_HEXAHEDRON, { 0, 1, 2, 3, 4, 5, 6 }), "7 points instead of 8");
  expectErrors(allFilters(), withCell(VTK_WEDGE, { 0, 1, 2, 3, 4, 5, 6 }), "7 points instead of 6");
  expectErrors(allFilters(), withCell(VTK_PYRAMID, { 0, 1, 2, 3 }), "4 points instead of 5");
  expectErrors(allFilters(), withCell(VTK_QUAD, { 0, 1, 2 }), "3 points instead of 4");
}

TEST_F(BadMixedCells, areOfASecondOrderOrOfOtherShapes)
{
  std::vector<vtkIdType> points(20);
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    points[k] = static_cast<vtkIdType>(k);
  }
  const std::vector<NamedFilter> ofLinearCells{ allFilters()[0], allFilters()[1], allFilters()[5] };
  expectErrors(
    ofLinearCells, withCell(VTK_QUADRATIC_HEXAHEDRON, points), "this filter takes linear cells");
  expectErrors(allFilters(), withCell(VTK_BIQUADRATIC_QUAD, { 0, 1, 2, 3, 4, 5, 6, 7, 8 }),
    "the mesh holds a biquadraticquad");
  expectErrors(allFilters(), withCell(VTK_PENTAGONAL_PRISM, { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9 }),
    "the mesh holds a pentagonalprism");
  expectErrors(allFilters(), withCell(VTK_POLYGON, { 0, 1, 2, 3, 4 }), "the mesh holds a polygon");
  // A quadratic tetrahedron among linear cells of other shapes.
  points.resize(10);
  expectErrors(
    ofLinearCells, withCell(VTK_QUADRATIC_TETRA, points), "this filter takes linear cells");
  const cadtest::Outcome outcome =
    allFilters()[2].attempt(filters, withCell(VTK_QUADRATIC_TETRA, points));
  EXPECT_FALSE(outcome.succeeded);
  EXPECT_EQ(outcome.errors.size(), exchange.rank() == 0 ? 1u : 0u);
}

TEST_F(BadMixedCells, areOnTwoRanks)
{
  if (exchange.size() > 1)
  {
    Mesh mesh = cadtest::hexahedralBallMesh(2, 0.02, 1, { 1 });
    const auto whole = cadtest::toGrid(mesh);
    auto rankOfCell = cadtest::deal(cadtest::Dealing::Blocks, whole, exchange.size());
    const auto piece = cadtest::pieceOf(whole, rankOfCell, exchange.rank(), true);
    piece->GetCellData()->RemoveArray("vtkGhostType");
    expectErrors(allFilters(), piece, "duplicate cells");
  }
}

/// Most decide how wedges are turned; the others are inverted.
TEST_F(BadMixedCells, wedgesOfBothOrientations)
{
  Mesh mesh = cadtest::mixedMesh(
    cadtest::hexahedraMesh(2, 0, 1), [](std::size_t) { return cadtest::BoxKind::Wedges; }, 1);
  for (Point3& point : mesh.points)
  {
    point = 4.0 * (point - Point3{ 0.5, 0.5, 0.5 }); // its corners are outside of the sphere
  }
  mesh.wedges[2] = turned(mesh.wedges[2]);
  mesh.wedges[5] = turned(mesh.wedges[5]);
  expectInvalid(pieceOf(cadtest::toGrid(mesh)), 2);
  for (auto& wedge : mesh.wedges)
  {
    wedge = turned(wedge);
  }
  expectInvalid(pieceOf(cadtest::toGrid(mesh)), 2);
}

TEST_F(BadMixedCells, areInvertedOrFolded)
{
  Mesh mesh = cadtest::hexahedralBallMesh(2, 0.02, 2, { 0.6, 1 });
  auto& inverted = mesh.hexahedra[30];
  inverted = { inverted[4], inverted[5], inverted[6], inverted[7], inverted[0], inverted[1],
    inverted[2], inverted[3] };
  auto& folded = mesh.hexahedra[40];
  std::swap(folded[5], folded[6]);
  expectInvalid(pieceOf(cadtest::toGrid(mesh)), 2);
}

TEST_F(BadMixedCells, quadrilateralsAreFoldedOrTurnTheOtherWay)
{
  Mesh mesh = cadtest::quadrilateralsMesh(4, 0, 1);
  std::swap(mesh.quadrilaterals[5][1], mesh.quadrilaterals[5][2]);
  std::swap(mesh.quadrilaterals[9][1], mesh.quadrilaterals[9][3]);
  const auto piece = pieceOf(cadtest::toGrid(mesh));
  const cadtest::Outcome outcome = allFilters()[2].attempt(filters, piece);
  EXPECT_TRUE(outcome.succeeded);
  EXPECT_EQ(cadtest::fieldValue(outcome.pointSet(), "InvalidCells"), 2);
}

TEST_F(BadMixedCells, coordinatesTooLargeForVolumes)
{
  expectLimitOfCoordinates(gridOnLastRank(mixedBall()));
}

/// Without global ids: every cell has points of its own, at the same places.
TEST_F(BadMixedCells, repeatedPointsAreOne)
{
  const Mesh mesh = mixedBall();
  Mesh apart = mesh;
  apart.points.clear();
  visitShapes(apart,
    [&](auto, auto& cells)
    {
      for (auto& cell : cells)
      {
        for (Index& corner : cell)
        {
          apart.points.push_back(mesh.points[corner]);
          corner = static_cast<Index>(apart.points.size()) - 1;
        }
      }
    });
  expectSame(filtersOfRawMeshes(), pieceOf(cadtest::toGrid(apart)), cadtest::toGrid(mesh));
}

/// Hexahedra and quadrilaterals with their corners in rows.
TEST_F(BadMixedCells, voxelsAndPixelsAreHexahedraAndQuadrilaterals)
{
  const Mesh mesh =
    cadtest::withListedBoundary(cadtest::hexahedralBallMesh(2, 0.02, 1, { 0.6, 1 }));
  const Grid whole = cadtest::toGrid(mesh);
  const auto inRows = Grid::New();
  inRows->SetPoints(whole->GetPoints());
  inRows->Allocate(1);
  const auto insert = [&](int type, const auto& cells)
  {
    for (const auto& cell : cells)
    {
      std::vector<vtkIdType> points(cell.begin(), cell.end());
      for (std::size_t k = 2; k < points.size(); k += 4)
      {
        std::swap(points[k], points[k + 1]);
      }
      inRows->InsertNextCell(type, static_cast<vtkIdType>(points.size()), points.data());
    }
  };
  insert(VTK_PIXEL, mesh.quadrilaterals);
  insert(VTK_VOXEL, mesh.hexahedra);
  expectSame(filtersOfRawMeshes(), pieceOf(inRows), whole);
}

} // namespace

} // namespace cadrefine
