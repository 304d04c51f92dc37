// The vertices that pieces share, also where the mesh is no manifold.

#include "DataSets.h"
#include "ParallelTest.h"
#include "Partition.h"
#include "TestMeshes.h"
#include "mesh/DistributedMesh.h"

#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace cadrefine
{

namespace
{

/// A number for the middle of a cell; by it, cells are dealt out.
using Place = std::function<double(const Point3&)>;

class SharedVerticesOfPieces : public ParallelTest
{
protected:
  /// As many cells to each rank, in the order of their places.
  std::vector<int> deal(vtkPointSet* whole, const Place& place) const
  {
    std::vector<std::pair<double, vtkIdType>> cells;
    for (vtkIdType c = 0; c < whole->GetNumberOfCells(); ++c)
    {
      double box[6];
      whole->GetCellBounds(c, box);
      cells.emplace_back(
        place({ (box[0] + box[1]) / 2, (box[2] + box[3]) / 2, (box[4] + box[5]) / 2 }), c);
    }
    std::sort(cells.begin(), cells.end());
    std::vector<int> rankOfCell(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
    {
      rankOfCell[cells[i].second] = static_cast<int>(i * exchange.size() / cells.size());
    }
    return rankOfCell;
  }

  /// What findShared finds is what it would find if all vertices were candidates.
  void expectAllFound(const Mesh& mesh, const Place& place)
  {
    const vtkSmartPointer<vtkPointSet> whole = cadtest::toGrid(mesh);
    cadtest::addGlobalIds(whole);
    const auto piece = cadtest::pieceOf(whole, deal(whole, place), exchange.rank(), false);
    const Mesh own = convert(exchange, piece).mesh;
    std::int64_t before = exchange.bytesSent();
    const SharedVertices found = findShared(exchange, own);
    bytesForFound = exchange.sum(exchange.bytesSent() - before);
    std::vector<Index> all(own.points.size());
    std::iota(all.begin(), all.end(), 0);
    before = exchange.bytesSent();
    const SharedVertices expected = findSharedVertices(exchange, own.ids, all);
    bytesForAll = exchange.sum(exchange.bytesSent() - before);
    EXPECT_EQ(found.neighbours, expected.neighbours);
    EXPECT_EQ(found.items, expected.items);
    EXPECT_TRUE(exchange.size() == 1 || !exchange.any(expected.neighbours.empty()));
  }

  std::int64_t bytesForFound = 0; ///< Of all ranks.
  std::int64_t bytesForAll = 0;
};

/// Boxes round slices along a diagonal overlap, and most of the vertices are in several.
double alongDiagonal(const Point3& p)
{
  return p[0] + p[1] + p[2];
}

/// One by one. Two of three are on one rank: no side of theirs on the common edge is met once.
double bySheet(const Point3& p)
{
  return std::atan2(p[1], p[0]);
}

TEST_F(SharedVerticesOfPieces, ofThreeSheetsAtAnEdge)
{
  const Mesh sheets = cadtest::threeSheetsMesh(9);
  expectAllFound(sheets, bySheet);
  expectAllFound(sheets, [](const Point3& p) { return -bySheet(p); });
  expectAllFound(sheets, alongDiagonal);
}

TEST_F(SharedVerticesOfPieces, ofCubesAtAnEdgeOrACorner)
{
  for (const auto& cubes : { cadtest::cubesAtAnEdgeMesh(4), cadtest::cubesAtACornerMesh(4) })
  {
    expectAllFound(cubes, alongDiagonal);
    expectAllFound(cubes, [](const Point3& p) { return p[2] - p[0] - p[1]; });
    expectAllFound(cubes, [](const Point3& p) { return std::abs(p[0] - 1) + std::abs(p[1] - 1); });
  }
}

TEST_F(SharedVerticesOfPieces, insideTetrahedraAreNotLookedFor)
{
  expectAllFound(cadtest::cubeMesh(12, 0, 1), alongDiagonal);
  EXPECT_TRUE(exchange.size() == 1 || bytesForFound < bytesForAll);
}

} // namespace

} // namespace cadrefine
