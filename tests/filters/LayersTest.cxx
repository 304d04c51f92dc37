// Boundary layers move along with their wall: the heights of the first cells, on any number of
// ranks.

#include "DataSets.h"
#include "FilterRun.h"
#include "MeshChecks.h"
#include "MixedMeshes.h"
#include "ParallelTest.h"
#include "Partition.h"
#include "TestShapes.h"

#include <vtkCell.h>
#include <vtkCellType.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <ostream>

namespace cadrefine
{

namespace
{

using cadtest::BoxKind;

/// Layers round a wall near a sphere or circle of radius 2.
struct LayerCase
{
  std::string name;
  int dimension;
  BoxKind kind;
  double first;  ///< Height.
  double growth; ///< From layer to layer.
  int layers;
  double offset; ///< Of the wall from the CAD, in radii.
  int parts;     ///< Of a side of the cube, or of the circle.
};

void PrintTo(const LayerCase& tried, std::ostream* out)
{
  *out << tried.name;
}

std::vector<double> heightsOf(const LayerCase& tried)
{
  std::vector<double> heights;
  double height = 0;
  for (int layer = 0; layer < tried.layers; ++layer)
  {
    height += tried.first * std::pow(tried.growth, layer);
    heights.push_back(height);
  }
  return heights;
}

Mesh meshOf(const LayerCase& tried)
{
  const auto heights = heightsOf(tried);
  if (tried.dimension == 2)
  {
    return cadtest::withListedBoundary(
      cadtest::quadrilateralRingMesh(2, tried.offset, tried.parts, heights));
  }
  const Mesh boxes = cadtest::hexahedralShellMesh(2, tried.offset, tried.parts, heights);
  const std::size_t inLayers = heights.size() * 6 * tried.parts * tried.parts;
  return cadtest::withListedBoundary(cadtest::mixedMesh(
    boxes, [&](std::size_t c) { return c < inLayers ? tried.kind : BoxKind::Fan; }, 1));
}

std::size_t verticesOnWall(const LayerCase& tried)
{
  return tried.dimension == 2 ? tried.parts : 6 * tried.parts * tried.parts + 2;
}

/// With the sides between the layers and what follows on them listed, as gmsh lists the surfaces
/// of all of its volumes.
Mesh withListedEnd(const LayerCase& tried)
{
  const std::size_t count = verticesOnWall(tried);
  return cadtest::withListedSides(meshOf(tried), tried.layers * count, count);
}

// The wall moves by 4 to 40 first heights; refined, by the bulge of the CAD over its facets.
const std::vector<LayerCase> cases{
  { "Wedges", 3, BoxKind::Wedges, 0.01, 1.7, 9, 0.02, 3 },
  { "Hexahedra", 3, BoxKind::Hexahedron, 0.01, 1.7, 9, 0.02, 3 },
  { "ThinHexahedra", 3, BoxKind::Hexahedron, 0.001, 1.7, 14, 0.02, 3 },
  { "ThinWedges", 3, BoxKind::Wedges, 0.001, 1.7, 14, 0.02, 3 },
  { "Quadrilaterals", 2, BoxKind::Hexahedron, 0.001, 1.5, 14, 0.02, 16 },
  // Thinner in all than the bulge of the CAD over a facet: what follows on the layers makes way.
  { "Shallow", 3, BoxKind::Wedges, 0.02, 2, 3, 0.02, 2 },
  { "ShallowHexahedra", 3, BoxKind::Hexahedron, 0.02, 2, 3, 0.02, 2 },
  { "ShallowQuadrilaterals", 2, BoxKind::Hexahedron, 0.002, 1.5, 6, 0.02, 12 },
};

class LayersTest : public ParallelTest
{
protected:
  cadtest::TemporaryFolder folder;

  cadtest::FilterRun filtersFor(int dimension) const
  {
    return cadtest::FilterRun(
      cadtest::writeInto(folder, dimension == 2 ? cadtest::circle(2) : cadtest::sphere(2), ".brep"),
      worldController());
  }

  vtkSmartPointer<vtkPointSet> pieceOf(const Mesh& mesh) const
  {
    const auto whole = cadtest::toGrid(mesh);
    const auto rankOfCell = cadtest::deal(cadtest::Dealing::Random, whole, exchange.size());
    return cadtest::pieceOf(whole, rankOfCell, exchange.rank(), false);
  }

  using Edge = std::array<GlobalId, 2>; ///< From the wall up.

  /// The normal of a wall at a point of it; zero elsewhere.
  using Wall = std::function<Vector3(const Point3&)>;

  static Vector3 onSphere(const Point3& p)
  {
    return std::abs(norm(p) - 2) < 1e-9 ? normalized(p) : Vector3{};
  }

  /// The first edges of the columns over the wall: those of cells of layers that leave the CAD.
  static std::map<GlobalId, Edge> firstEdges(const Mesh& mesh, const Wall& wall)
  {
    const auto isOnWall = [&](Index v) { return wall(mesh.points[v]) != Vector3{}; };
    std::map<GlobalId, Edge> edges;
    const auto take = [&](Index low, Index high)
    {
      if (isOnWall(high))
      {
        std::swap(low, high);
      }
      if (isOnWall(low) && !isOnWall(high))
      {
        const Edge edge{ mesh.ids[low], mesh.ids[high] };
        EXPECT_EQ(edges.emplace(edge[0], edge).first->second, edge) << "two columns on a vertex";
      }
    };
    visitOwnShapes(mesh,
      [&](auto shape, const auto& cells)
      {
        using Shape = decltype(shape);
        if constexpr (!isSimplex(Shape{}) && Shape::corners != 5)
        {
          for (const auto& cell : cells)
          {
            for (const auto& [a, b] : Shape::edges)
            {
              take(cell[a], cell[b]);
            }
          }
        }
      });
    return edges;
  }

  /// Along the normal of the wall.
  static double heightOf(const Mesh& mesh, const Edge& edge, const Wall& wall = onSphere)
  {
    const auto at = [&](GlobalId id)
    { return mesh.points[std::find(mesh.ids.begin(), mesh.ids.end(), id) - mesh.ids.begin()]; };
    return dot(at(edge[1]) - at(edge[0]), wall(at(edge[0])));
  }

  /// Of the whole mesh, on rank 0. Collective.
  Mesh expectSound(vtkPointSet* piece)
  {
    Mesh mesh = cadtest::toMesh(cadtest::gather(exchange, piece));
    EXPECT_EQ(cadtest::fieldValue(piece, "InvalidCells"), 0);
    if (exchange.rank() == 0)
    {
      EXPECT_TRUE(cadtest::isValid(mesh));
      EXPECT_TRUE(cadtest::isBoundedByListedCells(mesh));
    }
    return mesh;
  }

  /// All of the wall is on the CAD, and its first cells are so high: expected(first edge).
  template<class Expected>
  void expectKept(vtkPointSet* piece, std::size_t wallVertices, const Expected& expected,
    const Wall& wall = onSphere)
  {
    expectHeights(expectSound(piece), piece, wallVertices, expected, wall);
  }

  /// The same, given the whole mesh on rank 0.
  template<class Expected>
  void expectHeights(const Mesh& mesh, vtkPointSet* piece, std::size_t wallVertices,
    const Expected& expected, const Wall& wall = onSphere)
  {
    EXPECT_EQ(cadtest::fieldValue(piece, "InvalidCells"), 0);
    EXPECT_EQ(cadtest::fieldValue(piece, "UnprojectedVertices"), 0);
    if (exchange.rank() > 0)
    {
      return;
    }
    const auto edges = firstEdges(mesh, wall);
    EXPECT_EQ(edges.size(), wallVertices);
    for (const auto& [vertex, edge] : edges)
    {
      const double height = expected(edge);
      EXPECT_NEAR(heightOf(mesh, edge, wall), height, 0.01 * height) << "over vertex " << vertex;
    }
  }
};

class Layers
  : public LayersTest
  , public testing::WithParamInterface<LayerCase>
{
protected:
  cadtest::FilterRun filters = filtersFor(GetParam().dimension);

  vtkSmartPointer<vtkPointSet> piece() const { return pieceOf(meshOf(GetParam())); }
};

INSTANTIATE_TEST_SUITE_P(
  Cases, Layers, testing::ValuesIn(cases), [](const auto& each) { return each.param.name; });

/// Visits the quadrilaterals of cells of second order of one type that stand on the wall:
/// visit(corners and mid nodes of the cell, edges of the quadrilateral, that on the wall first).
template<class Shape, class Visit>
int forQuadsOnWall(Shape, int type, vtkPointSet* mesh, const Visit& visit)
{
  int count = 0;
  for (vtkIdType c = 0; c < mesh->GetNumberOfCells(); ++c)
  {
    if (mesh->GetCellType(c) != type)
    {
      continue;
    }
    std::vector<Point3> nodes(mesh->GetCell(c)->GetNumberOfPoints());
    for (std::size_t k = 0; k < nodes.size(); ++k)
    {
      mesh->GetPoint(mesh->GetCell(c)->GetPointId(static_cast<int>(k)), nodes[k].data());
    }
    const auto isOnWall = [&](int edge)
    {
      const auto& [a, b] = Shape::edges[edge];
      return std::abs(norm(nodes[a]) - 2) < 1e-9 && std::abs(norm(nodes[b]) - 2) < 1e-9;
    };
    for (const auto& quad : Shape::quadEdges)
    {
      for (int k = 0; k < 4; ++k)
      {
        if (isOnWall(quad[k]) && !isOnWall(quad[(k + 1) % 4]) && !isOnWall(quad[(k + 2) % 4]))
        {
          visit(nodes, quad[k], quad[(k + 2) % 4]);
          ++count;
        }
      }
    }
  }
  return count;
}

/// Mid nodes over the wall go along with those on it.
TEST_P(Layers, areAsHighAtMidNodes)
{
  const auto mesh = filters.refineUniformly(filters.project(piece()));
  const auto curved = filters.run<vtkRefineWithCAD>(mesh,
    [](vtkRefineWithCAD* filter)
    {
      filter->SetLevels(0);
      filter->QuadraticCellsOn();
    });
  EXPECT_EQ(cadtest::fieldValue(curved, "InvalidCells"), 0);
  // The pyramids on hexahedra keep straight edges: all of a move has to fade out below them.
  const bool isHeld = GetParam().name == "ShallowHexahedra";
  EXPECT_EQ(cadtest::fieldValue(curved, "UnprojectedVertices") > 0, isHeld);
  const auto expectHigh = [&](auto shape, const std::vector<Point3>& nodes, int low, int high)
  {
    using Shape = decltype(shape);
    const auto straight = [&](int edge)
    { return 0.5 * (nodes[Shape::edges[edge][0]] + nodes[Shape::edges[edge][1]]); };
    const Point3& onWall = nodes[Shape::corners + low];
    EXPECT_NEAR(norm(onWall), 2, isHeld ? 0.005 : 1e-9);
    const double height = distance(straight(low), straight(high));
    EXPECT_NEAR(distance(onWall, nodes[Shape::corners + high]), height, 0.01 * height);
  };
  std::int64_t count = 0;
  const auto lookAt = [&](auto shape, int type)
  {
    count += forQuadsOnWall(shape, type, curved,
      [&](const auto& nodes, int low, int high) { expectHigh(shape, nodes, low, high); });
  };
  lookAt(shapes::Wedge{}, VTK_QUADRATIC_WEDGE);
  lookAt(shapes::Hexahedron{}, VTK_QUADRATIC_HEXAHEDRON);
  lookAt(shapes::Quadrilateral{}, VTK_QUADRATIC_QUAD);
  EXPECT_GT(exchange.sum(count), 20);
}

TEST_P(Layers, keepTheirFirstHeights)
{
  const int n = GetParam().parts;
  const auto mesh = filters.project(piece());
  const auto expectHeight = [&](vtkPointSet* refined, std::size_t wallVertices, double height)
  { expectKept(refined, wallVertices, [&](const Edge&) { return height * GetParam().first; }); };
  const auto verticesOf = [](vtkPointSet* refined)
  { return static_cast<std::size_t>(cadtest::fieldValue(refined, "CADVertices")); };
  {
    SCOPED_TRACE("projected");
    expectHeight(mesh, verticesOnWall(GetParam()), 1);
  }
  {
    SCOPED_TRACE("refined along the wall");
    const auto refined = filters.run<vtkRefineWithCAD>(mesh, [](vtkRefineWithCAD*) {});
    expectHeight(refined, verticesOf(refined), 1);
  }
  const auto uniform = filters.refineUniformly(mesh); // through the layers, too
  {
    SCOPED_TRACE("refined uniformly");
    expectHeight(uniform, GetParam().dimension == 2 ? 2 * n : 24 * n * n + 2, 0.5);
  }
  {
    SCOPED_TRACE("refined uniformly once more");
    const auto refined = filters.refineUniformly(uniform);
    expectHeight(refined, verticesOf(refined), 0.25);
  }
}

TEST_P(Layers, keepTheirFirstHeightsWhereTheirEndIsListed)
{
  const int n = GetParam().parts;
  const auto mesh = filters.project(pieceOf(withListedEnd(GetParam())));
  const auto expectHeight = [&](vtkPointSet* data, std::size_t wallVertices, double height)
  {
    EXPECT_EQ(cadtest::fieldValue(data, "CADVertices"), wallVertices);
    expectHeights(cadtest::toMesh(cadtest::gather(exchange, data)), data, wallVertices,
      [&](const Edge&) { return height * GetParam().first; });
  };
  expectHeight(mesh, verticesOnWall(GetParam()), 1);
  const auto refined = filters.refineUniformly(mesh);
  expectHeight(refined, GetParam().dimension == 2 ? 2 * n : 24 * n * n + 2, 0.5);
}

/// Of edges that are unequal it is the height over the facets that stays, as generators make them
/// longer where the wall turns.
TEST_F(LayersTest, ofUnequalEdgesAreAsHighOverFacets)
{
  const LayerCase& ring = *std::find_if(
    cases.begin(), cases.end(), [](const LayerCase& each) { return each.dimension == 2; });
  Mesh mesh = meshOf(ring);
  const auto wall = static_cast<std::size_t>(ring.parts);
  for (std::size_t v = wall; v < wall * (1 + ring.layers); ++v)
  {
    const Vector3 up = mesh.points[v] - mesh.points[v % wall];
    mesh.points[v] = mesh.points[v] + 0.2 * normalized(up)[0] * up;
  }
  const cadtest::FilterRun filters = filtersFor(2);
  const auto projected = filters.project(pieceOf(mesh));
  const Mesh straight =
    cadtest::toMesh(cadtest::gather(exchange, filters.refineStraight(projected)));
  expectKept(filters.refineUniformly(projected), 2 * wall,
    [&](const Edge& edge)
    { return heightOf(straight, edge, [](const Point3& p) { return normalized(p); }); });
}

/// Round an ellipse: where the curvature changes, the normal is not halfway between those beside.
class EllipticLayers : public LayersTest
{
protected:
  static constexpr double length = 1.5;
  static constexpr double height = 0.6;
  static constexpr int corners = 16;
  static constexpr double first = 0.001;

  static Vector3 normalAt(const Point3& p)
  {
    return normalized(Vector3{ p[0] / (length * length), p[1] / (height * height), 0 });
  }

  static Vector3 onEllipse(const Point3& p)
  {
    const double size = p[0] * p[0] / (length * length) + p[1] * p[1] / (height * height);
    return std::abs(size - 1) < 1e-9 ? normalAt(p) : Vector3{};
  }

  /// The columns stand on the normals. What is over `layers` is triangles.
  static Mesh meshOf(const std::vector<double>& heights, std::size_t layers)
  {
    Mesh mesh = cadtest::quadrilateralRingMesh(1, 0, corners, heights);
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
    {
      const std::size_t level = v / corners;
      const Point3 onUnit = normalized(mesh.points[v]);
      const Point3 onWall{ length * onUnit[0], height * onUnit[1], 0 };
      mesh.points[v] = level == 0                ? onWall
                       : level <= heights.size() ? onWall + heights[level - 1] * normalAt(onWall)
                                                 : 3.0 * onUnit;
    }
    for (std::size_t q = layers * corners; q < mesh.quadrilaterals.size(); ++q)
    {
      const auto& [a, b, c, d] = mesh.quadrilaterals[q];
      mesh.triangles.insert(mesh.triangles.end(), { { a, b, c }, { a, c, d } });
    }
    mesh.quadrilaterals.resize(std::min(mesh.quadrilaterals.size(), layers * corners));
    return cadtest::withListedBoundary(mesh);
  }

  void expectKeptUnderRefinement(const Mesh& mesh)
  {
    const cadtest::FilterRun filters(
      cadtest::writeInto(folder, cadtest::ellipse(length, height), ".brep"), worldController());
    auto refined = filters.project(pieceOf(mesh));
    for (int level = 1; level <= 2; ++level)
    {
      refined = filters.refineUniformly(refined);
      expectKept(
        refined, corners << level, [&](const Edge&) { return first / (1 << level); }, onEllipse);
    }
  }
};

TEST_F(EllipticLayers, standOnTheNormals)
{
  const LayerCase thick{ "", 2, BoxKind::Hexahedron, first, 1.5, 12, 0, corners };
  expectKeptUnderRefinement(meshOf(heightsOf(thick), 12));
}

/// The triangles over the layers are flatter than the CAD bulges: walls come there in two rounds.
TEST_F(EllipticLayers, standOnTheNormalsWhereCellsMakeWay)
{
  const LayerCase thin{ "", 2, BoxKind::Hexahedron, first, 1.5, 5, 0, corners };
  expectKeptUnderRefinement(meshOf(heightsOf(thin), 4));
}

/// Cells through a wall whose both sides are on the CAD, which bulges by more than it is thick.
class ThinWalls
  : public ParallelTest
  , public testing::WithParamInterface<BoxKind>
{
};

INSTANTIATE_TEST_SUITE_P(Cases, ThinWalls, testing::Values(BoxKind::Hexahedron, BoxKind::Wedges));

TEST_P(ThinWalls, followBothSides)
{
  constexpr double thickness = 0.06;
  const cadtest::TemporaryFolder folder;
  const cadtest::FilterRun filters(
    cadtest::writeInto(
      folder, cadtest::together(cadtest::sphere(2), cadtest::sphere(2 + thickness)), ".brep"),
    worldController());
  const Mesh boxes = cadtest::hexahedralWallMesh(2, 2, { 0.01, 0.03, thickness });
  const auto whole = cadtest::toGrid(cadtest::mixedMesh(
    boxes, [](std::size_t) { return GetParam(); }, 1));
  auto mesh = filters.project(cadtest::pieceOf(whole,
    cadtest::deal(cadtest::Dealing::Random, whole, exchange.size()), exchange.rank(), false));
  for (int level = 0; level < 2; ++level)
  {
    mesh = filters.refineUniformly(mesh);
    EXPECT_EQ(cadtest::fieldValue(mesh, "UnprojectedVertices"), 0);
    EXPECT_EQ(cadtest::fieldValue(mesh, "InvalidCells"), 0);
    const Mesh piece = cadtest::toMesh(mesh);
    for (const Point3& point : piece.points)
    {
      EXPECT_GE(norm(point), 2 - 1e-9);
      EXPECT_LE(norm(point), 2 + thickness + 1e-9);
    }
  }
}

/// Ten thin layers on the inner one of two walls on the CAD, and three thick ones to the outer one,
/// which is within fewer cells of half of the thin ones.
TEST_F(LayersTest, ofOneWallAreKeptBesideAnother)
{
  constexpr int parts = 3;
  const LayerCase thin{ "", 3, BoxKind::Hexahedron, 0.01, 1.3, 10, 0, parts };
  auto heights = heightsOf(thin);
  heights.insert(heights.end(), { 1.5, 2.7 });
  const Mesh mesh = cadtest::hexahedralShellMesh(2, 0, parts, heights); // to a radius of 6
  const cadtest::FilterRun filters(
    cadtest::writeInto(folder, cadtest::together(cadtest::sphere(2), cadtest::sphere(6)), ".brep"),
    worldController());
  auto refined = filters.project(pieceOf(cadtest::withListedBoundary(mesh)));
  for (int level = 1; level <= 2; ++level)
  {
    refined = filters.refineUniformly(refined);
    const auto facets = static_cast<std::size_t>(6 * parts * parts) << (2 * level);
    expectKept(refined, facets + 2, [&](const Edge&) { return thin.first / (1 << level); });
  }
}

} // namespace

} // namespace cadrefine
