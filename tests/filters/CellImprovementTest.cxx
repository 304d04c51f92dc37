// Local operations over ranks: the same mesh, bit for bit, and all that belongs to it.

#include "pipeline/CellImprovement.h"
#include "DataSets.h"
#include "FilterRun.h"
#include "MeshChecks.h"
#include "ParallelTest.h"
#include "Partition.h"
#include "SamePieces.h"
#include "TestMeshes.h"
#include "TestShapes.h"
#include "pipeline/LocalOperations.h"

#include <cadrefine/cad/import/CADFile.h>
#include <cadrefine/mesh/Orientation.h>
#include <cadrefine/mesh/Quality.h>

#include <vtkCADReader.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace cadrefine
{

namespace
{

/// The mean ratios of a mesh, and its volume on either side of x = 1 by the array Material.
struct Shape
{
  double worst = 2;
  std::array<double, 2> volumes{};
  int below = 0; ///< Cells of a mean ratio below 0.2.
};

Shape shapeOf(vtkPointSet* mesh)
{
  Shape shape;
  vtkDataArray* materials = mesh->GetCellData()->GetArray("Material");
  for (vtkIdType c = 0; c < mesh->GetNumberOfCells(); ++c)
  {
    if (mesh->GetCellType(c) != VTK_TETRA)
    {
      continue;
    }
    vtkNew<vtkIdList> ids;
    mesh->GetCellPoints(c, ids);
    std::array<Point3, 4> p;
    for (int k = 0; k < 4; ++k)
    {
      mesh->GetPoint(ids->GetId(k), p[k].data());
    }
    const double quality = meanRatio(p[0], p[1], p[2], p[3]);
    shape.worst = std::min(shape.worst, quality);
    shape.below += quality < 0.2;
    shape.volumes[static_cast<std::size_t>(materials->GetTuple1(c))] +=
      sixfoldVolume(p[0], p[1], p[2], p[3]) / 6;
  }
  return shape;
}

/// The box with a hole, projected, with two materials that meet in a jagged interface, and with
/// vertices inside these at random places, as far as cells stay valid.
vtkSmartPointer<vtkPointSet> spoiltMesh(const cadtest::FilterRun& filters)
{
  Mesh mesh = cadtest::toMesh(filters.refineUniformly(
    filters.project(cadtest::readGrid(CADREFINE_TRUTH "/box_minus_cylinder_coarse.vtu"))));
  const std::set<Index> outer = cadtest::outerVertices(mesh);
  std::vector<std::vector<std::size_t>> cellsAt(mesh.points.size());
  for (std::size_t c = 0; c < mesh.tetrahedra.size(); ++c)
  {
    for (const Index vertex : mesh.tetrahedra[c])
    {
      cellsAt[vertex].push_back(c);
    }
  }
  const auto materialOf = [&](std::size_t c)
  {
    double sum = 0;
    for (const Index vertex : mesh.tetrahedra[c])
    {
      sum += mesh.points[vertex][0];
    }
    return sum > 4 ? 1 : 0;
  };
  vtkNew<vtkIntArray> materials;
  materials->SetName("Material");
  std::vector<int> materialsOfCells;
  for (std::size_t c = 0; c < mesh.tetrahedra.size(); ++c)
  {
    materialsOfCells.push_back(materialOf(c));
    materials->InsertNextValue(materialsOfCells.back());
  }
  std::mt19937 random(7);
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
  {
    const auto part = [&] { return 0.3 * (static_cast<double>(random() % 4096) / 4096 - 0.5); };
    const Point3 start = mesh.points[v];
    const bool isOfOneMaterial = std::all_of(cellsAt[v].begin(), cellsAt[v].end(),
      [&](std::size_t c) { return materialsOfCells[c] == materialsOfCells[cellsAt[v][0]]; });
    if (isOfOneMaterial && outer.count(static_cast<Index>(v)) == 0)
    {
      mesh.points[v] = start + Point3{ part(), part(), part() };
      const auto isValid = [&](std::size_t c)
      {
        const auto& [i, j, k, l] = mesh.tetrahedra[c];
        return orientation(mesh.points[i], mesh.points[j], mesh.points[k], mesh.points[l]) > 0;
      };
      if (!std::all_of(cellsAt[v].begin(), cellsAt[v].end(), isValid))
      {
        mesh.points[v] = start;
      }
    }
  }
  mesh.triangles.clear();
  mesh.segments.clear();
  mesh.vertices.clear();
  const auto grid = cadtest::toGrid(mesh);
  grid->GetCellData()->AddArray(materials);
  auto projected = filters.moveOntoCAD(grid);
  projected->GetFieldData()->Initialize();
  return projected;
}

class CellImprovement
  : public ParallelTest
  , public testing::WithParamInterface<cadtest::Dealing>
{
protected:
  vtkSmartPointer<vtkPointSet> improved(
    RankExchange& ranks, vtkPointSet* piece, const CADModel& model)
  {
    RunStatistics statistics;
    const PipelineContext context{ ranks, model, statistics, [](const std::string&) {} };
    MeshState state = readMesh(ranks, piece);
    readClassification(context, piece, state);
    improveMesh(context, state, { 0.3, {}, 1000 });
    return makeDataSet(state);
  }

  /// What becomes of a mesh on one rank, on rank 0; of its pieces it is the same.
  vtkSmartPointer<vtkPointSet> improvedAlike(vtkPointSet* whole, const CADModel& model)
  {
    const auto rankOfCell = cadtest::deal(GetParam(), whole, exchange.size());
    const auto piece = cadtest::pieceOf(whole, rankOfCell, exchange.rank(), false);
    const auto pieces = improved(exchange, piece, model);
    RankExchange alone(nullptr);
    auto serial = exchange.rank() == 0 ? improved(alone, whole, model) : nullptr;
    cadtest::expectSame(exchange, pieces, serial);
    return serial;
  }
};

class RankWithoutCells : public ParallelTest
{
};

TEST_P(CellImprovement, isThatOfOneRank)
{
  const cadtest::FilterRun filters(CADREFINE_TRUTH "/box_minus_cylinder.brep");
  const auto whole = spoiltMesh(filters);
  const auto model = readCADFile(CADREFINE_TRUTH "/box_minus_cylinder.brep");
  const auto serial = improvedAlike(whole, *model);
  if (exchange.rank() == 0)
  {
    const Shape before = shapeOf(whole);
    const Shape after = shapeOf(serial);
    EXPECT_LT(before.worst, 0.02);
    EXPECT_GT(after.worst, 0.1);
    EXPECT_LT(after.below, before.below / 20);
    for (const int material : { 0, 1 })
    {
      // Facets round the hole may change.
      EXPECT_NEAR(after.volumes[material], before.volumes[material], 0.01);
    }
    EXPECT_TRUE(cadtest::isValid(cadtest::toMesh(serial)));
    EXPECT_TRUE(cadtest::hasNoHangingVertex(cadtest::toMesh(serial)));
  }
}

/// The edges of every tetrahedron, or of every so many.
std::set<std::array<Index, 2>> edgesOf(const Mesh& mesh, std::size_t step = 1)
{
  std::set<std::array<Index, 2>> edges;
  for (std::size_t c = 0; c < mesh.tetrahedra.size(); c += step)
  {
    for (const auto& [i, j] : tetrahedronEdges)
    {
      const auto [low, high] = std::minmax(mesh.tetrahedra[c][i], mesh.tetrahedra[c][j]);
      edges.insert({ low, high });
    }
  }
  return edges;
}

/// Listed segments stay edges of cells, also those between vertices of several blocks.
TEST_P(CellImprovement, keepsListedSegments)
{
  const cadtest::FilterRun filters(CADREFINE_TRUTH "/box_minus_cylinder.brep");
  Mesh mesh = cadtest::toMesh(spoiltMesh(filters));
  const auto listed = edgesOf(mesh, 7);
  mesh.segments = { listed.begin(), listed.end() };
  const auto whole = filters.moveOntoCAD(cadtest::toGrid(mesh));
  const auto model = readCADFile(CADREFINE_TRUTH "/box_minus_cylinder.brep");
  const auto rankOfCell = cadtest::deal(GetParam(), whole, exchange.size());
  const auto piece = cadtest::pieceOf(whole, rankOfCell, exchange.rank(), false);
  const auto gathered = cadtest::gather(exchange, improved(exchange, piece, *model));
  if (exchange.rank() == 0)
  {
    const Mesh after = cadtest::toMesh(gathered);
    EXPECT_NE(after.tetrahedra.size(), mesh.tetrahedra.size());
    EXPECT_GE(after.segments.size(), mesh.segments.size());
    const auto edges = edgesOf(after);
    for (const auto& [a, b] : after.segments)
    {
      EXPECT_EQ(edges.count({ std::min(a, b), std::max(a, b) }), 1U) << a << " " << b;
    }
  }
}

/// Adds fins and beams that end at new points, and triangles and segments through the mesh.
void addStrays(Mesh& mesh)
{
  const auto edges = edgesOf(mesh);
  const auto isEdge = [&](Index a, Index b) {
    return a == b || edges.count({ std::min(a, b), std::max(a, b) }) > 0;
  };
  for (std::size_t c = 0; c + 40 < mesh.tetrahedra.size(); c += 37)
  {
    const auto& [a, b, other, another] = mesh.tetrahedra[c];
    const auto tip = static_cast<Index>(mesh.points.size());
    mesh.points.push_back(mesh.points[a] + Point3{ 0, 0, 5 + 0.001 * static_cast<double>(c) });
    mesh.segments.push_back({ a, tip });
    mesh.triangles.push_back({ b, a, tip });
    const Index far = mesh.tetrahedra[c + 40][0];
    if (!isEdge(a, far) && !isEdge(b, far))
    {
      mesh.segments.push_back({ b, far });
      mesh.triangles.push_back({ far, a, b });
    }
  }
}

/// How many beams of addStrays are there with the fin beside them.
int beamsWithFin(const Mesh& mesh)
{
  std::set<std::array<Index, 2>> ofFins;
  for (const auto& corners : mesh.triangles)
  {
    for (const Index a : corners)
    {
      for (const Index b : corners)
      {
        ofFins.insert({ a, b });
      }
    }
  }
  return static_cast<int>(std::count_if(mesh.segments.begin(), mesh.segments.end(),
    [&](const std::array<Index, 2>& ends)
    {
      return std::max(mesh.points[ends[0]][2], mesh.points[ends[1]][2]) > 4 &&
             ofFins.count(ends) > 0;
    }));
}

/// Listed cells that are no sides of cells, of which vertices may be in several blocks, or in none.
TEST_P(CellImprovement, keepsFinsAndBeams)
{
  const cadtest::FilterRun filters(CADREFINE_TRUTH "/box_minus_cylinder.brep");
  Mesh mesh = cadtest::toMesh(spoiltMesh(filters));
  addStrays(mesh);
  const auto whole = filters.moveOntoCAD(cadtest::toGrid(mesh));
  whole->GetFieldData()->Initialize();
  const auto model = readCADFile(CADREFINE_TRUTH "/box_minus_cylinder.brep");
  const auto serial = improvedAlike(whole, *model);
  if (exchange.rank() == 0)
  {
    const Mesh after = cadtest::toMesh(serial);
    EXPECT_NE(after.tetrahedra.size(), mesh.tetrahedra.size());
    EXPECT_TRUE(cadtest::isValid(after));
    EXPECT_GT(beamsWithFin(mesh), 10);
    EXPECT_GE(beamsWithFin(after), beamsWithFin(mesh)); // halved with cells that are
  }
}

/// Its only cell is taken out, whose vertices were shared.
TEST_F(RankWithoutCells, sharesNoVertexAnyMore)
{
  const auto whole = cadtest::toGrid(cadtest::cubeMesh(1, 0, 1));
  cadtest::addGlobalIds(whole);
  std::vector<int> rankOfCell(static_cast<std::size_t>(whole->GetNumberOfCells()), 0);
  rankOfCell.back() = exchange.size() - 1;
  const auto model = cadtest::modelOf(cadtest::box(1, 1, 1));
  RunStatistics statistics;
  const PipelineContext context{ exchange, *model, statistics, [](const std::string&) {} };
  MeshState state = readMesh(exchange, cadtest::pieceOf(whole, rankOfCell, exchange.rank(), false));
  setClassification(state, Classification(state.mesh.mesh().points.size()));
  EXPECT_EQ(
    state.mesh.shared.all.empty(), exchange.size() == 1 || state.mesh.mesh().points.empty());

  const std::size_t cells = state.mesh.mesh().tetrahedra.size();
  const auto isLast = [&](Index cell)
  { return exchange.rank() == exchange.size() - 1 && cell == static_cast<Index>(cells) - 1; };
  const auto takeOut = [](BlockMesh& block, const SurfaceRule&)
  {
    Cavity cavity;
    cavity.cells = { 0 };
    block.mesh().replace(cavity);
    OperationResult result;
    result.counts.collapses = 1;
    return result;
  };
  const std::vector<unsigned char> everywhere(state.mesh.mesh().points.size(), 1);
  EXPECT_EQ(operateOnMesh(context, state, everywhere, { 1, 0, 1000, isLast }, takeOut), 1);
  EXPECT_EQ(countMesh(exchange, state.mesh).cells, 5);
  EXPECT_EQ(countMesh(exchange, state.mesh).vertices, 8);
  EXPECT_TRUE(state.mesh.shared.all.empty());
}

/// Gives the triangles materials by the side of x = 0 on which their centroids are, and moves
/// vertices inside these to placeOf(vertex, a random point near it), unless triangles turn over.
template<class PlaceOf>
vtkSmartPointer<vtkUnstructuredGrid> spoiltTriangles(Mesh mesh, double part, const PlaceOf& placeOf)
{
  std::vector<std::vector<std::size_t>> cellsAt(mesh.points.size());
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c)
  {
    for (const Index vertex : mesh.triangles[c])
    {
      cellsAt[vertex].push_back(c);
    }
  }
  const auto sideOf = [&](std::size_t c)
  {
    const auto& [i, j, k] = mesh.triangles[c];
    return twofoldAreaVector(mesh.points[i], mesh.points[j], mesh.points[k]);
  };
  const auto materialOf = [&](std::size_t c)
  {
    const auto& [i, j, k] = mesh.triangles[c];
    return mesh.points[i][0] + mesh.points[j][0] + mesh.points[k][0] > 0 ? 1 : 0;
  };
  vtkNew<vtkIntArray> materials;
  materials->SetName("Material");
  std::vector<int> ofCells;
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c)
  {
    ofCells.push_back(materialOf(c));
    materials->InsertNextValue(ofCells.back());
  }
  std::mt19937 random(5);
  const auto at = [&] { return part * (static_cast<double>(random() % 4096) / 4096 - 0.5); };
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
  {
    const Point3 start = mesh.points[v];
    const bool isOfOneMaterial = std::all_of(cellsAt[v].begin(), cellsAt[v].end(),
      [&](std::size_t c) { return ofCells[c] == ofCells[cellsAt[v][0]]; });
    std::vector<Vector3> sides;
    std::transform(cellsAt[v].begin(), cellsAt[v].end(), std::back_inserter(sides), sideOf);
    const Point3 place = placeOf(static_cast<Index>(v), start + Vector3{ at(), at(), at() });
    if (!isOfOneMaterial)
    {
      continue;
    }
    mesh.points[v] = place;
    for (std::size_t k = 0; k < sides.size(); ++k)
    {
      const Vector3 now = sideOf(cellsAt[v][k]);
      if (dot(now, sides[k]) < 0.05 * squaredNorm(sides[k]))
      {
        mesh.points[v] = start;
      }
    }
  }
  mesh.segments.clear();
  mesh.vertices.clear();
  auto grid = cadtest::toGrid(mesh);
  grid->GetCellData()->AddArray(materials);
  return grid;
}

/// The areas of triangles by their material, and the worst.
Shape shapeOfTriangles(vtkPointSet* data)
{
  const Mesh mesh = cadtest::toMesh(data);
  vtkDataArray* materials = data->GetCellData()->GetArray("Material");
  Shape shape;
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c)
  {
    const auto& [i, j, k] = mesh.triangles[c];
    const double quality = meanRatio(mesh.points[i], mesh.points[j], mesh.points[k]);
    shape.worst = std::min(shape.worst, quality);
    shape.below += quality < 0.2;
    shape.volumes[static_cast<std::size_t>(materials->GetTuple1(static_cast<vtkIdType>(c)))] +=
      0.5 * norm(twofoldAreaVector(mesh.points[i], mesh.points[j], mesh.points[k]));
  }
  return shape;
}

class TriangleImprovement : public CellImprovement
{
protected:
  /// The shapes before and after, on rank 0, where the pieces' result is that of one rank.
  struct Shapes
  {
    Shape before;
    Shape after;
    Mesh mesh;
  };

  Shapes compare(vtkPointSet* whole, const CADModel& model)
  {
    const auto serial = improvedAlike(whole, model);
    return serial
             ? Shapes{ shapeOfTriangles(whole), shapeOfTriangles(serial), cadtest::toMesh(serial) }
             : Shapes{};
  }
};

TEST_P(TriangleImprovement, inThePlaneIsThatOfOneRank)
{
  const cadtest::TemporaryFolder folder;
  const std::string file = cadtest::writeInto(folder, cadtest::circle(1), ".step");
  const cadtest::FilterRun filters(file);
  const Mesh disc = cadtest::toMesh(
    filters.refineUniformly(filters.project(cadtest::toGrid(cadtest::discMesh(1, 0.02, 12))), 3));
  const std::set<Index> outer = cadtest::outerVertices(disc);
  const auto whole = filters.moveOntoCAD(spoiltTriangles(disc, 0.2,
    [&](Index v, const Point3& point) {
      return outer.count(v) > 0 ? disc.points[v] : Point3{ point[0], point[1], 0 };
    }));
  whole->GetFieldData()->Initialize();
  const Shapes shapes = compare(whole, *readCADFile(file));
  if (exchange.rank() == 0)
  {
    EXPECT_LT(shapes.before.worst, 0.1);
    EXPECT_GT(shapes.after.worst, 0.29);
    EXPECT_GT(shapes.before.below, 20);
    EXPECT_EQ(shapes.after.below, 0);
    for (const int material : { 0, 1 })
    {
      EXPECT_NEAR(shapes.after.volumes[material], shapes.before.volumes[material], 1e-13);
    }
    EXPECT_TRUE(cadtest::isValid(shapes.mesh));
    EXPECT_TRUE(cadtest::hasNoHangingVertex(shapes.mesh));
    EXPECT_EQ(cadtest::countOuterSides(shapes.mesh), 96u) << "the circle's chords stay";
    EXPECT_TRUE(std::all_of(shapes.mesh.points.begin(), shapes.mesh.points.end(),
      [](const Point3& point) { return point[2] == 0; }));
  }
}

TEST_P(TriangleImprovement, onASurfaceIsThatOfOneRank)
{
  const cadtest::TemporaryFolder folder;
  const std::string file = cadtest::writeInto(folder, cadtest::sphere(1), ".step");
  const cadtest::FilterRun filters(file);
  const Mesh sphere = cadtest::toMesh(
    filters.refineUniformly(filters.project(cadtest::toGrid(cadtest::sphereMesh(1, 0.02))), 3));
  const auto whole = filters.moveOntoCAD(
    spoiltTriangles(sphere, 0.25, [](Index, const Point3& point) { return normalized(point); }));
  whole->GetFieldData()->Initialize();
  const Shapes shapes = compare(whole, *readCADFile(file));
  if (exchange.rank() == 0)
  {
    EXPECT_LT(shapes.before.worst, 0.15);
    EXPECT_GT(shapes.after.worst, 0.25);
    EXPECT_LT(shapes.after.below, shapes.before.below / 5);
    EXPECT_TRUE(cadtest::isValid(shapes.mesh));
    EXPECT_TRUE(cadtest::hasNoHangingVertex(shapes.mesh));
    EXPECT_EQ(cadtest::countOuterSides(shapes.mesh), 0u);
    for (const Point3& point : shapes.mesh.points)
    {
      EXPECT_NEAR(norm(point), 1, 1e-9);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Dealings, TriangleImprovement,
  testing::Values(cadtest::Dealing::Blocks, cadtest::Dealing::Random, cadtest::Dealing::KdTree,
    cadtest::Dealing::EmptyRank));

INSTANTIATE_TEST_SUITE_P(Dealings, CellImprovement,
  testing::Values(cadtest::Dealing::Blocks, cadtest::Dealing::Random, cadtest::Dealing::KdTree,
    cadtest::Dealing::EmptyRank));

} // namespace

} // namespace cadrefine
