// Fields of cells that change: integrals stay, what is linear or constant stays so, on any ranks.

#include "BlockMeshes.h"
#include "DataSets.h"
#include "FilterRun.h"
#include "HexahedralMeshes.h"
#include "MeshChecks.h"
#include "ParallelTest.h"
#include "Partition.h"
#include "SamePieces.h"
#include "SpoiltCube.h"
#include "TestShapes.h"
#include "pipeline/CellImprovement.h"

#include <cadrefine/mesh/Overlap.h>

#include <vtkAdaptToCAD.h>
#include <vtkCellData.h>
#include <vtkCoarsenWithCAD.h>
#include <vtkDoubleArray.h>
#include <vtkIdList.h>
#include <vtkIntArray.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <TopoDS_Shape.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

namespace cadrefine
{
namespace
{

template<std::size_t Corners>
double sizeOf(vtkPointSet* mesh, vtkIdList* ids)
{
  SimplexPoints<Corners> corners;
  for (std::size_t k = 0; k < Corners; ++k)
  {
    mesh->GetPoint(ids->GetId(static_cast<vtkIdType>(k)), corners[k].data());
  }
  return measure(corners);
}

/// The integral of a component over the tetrahedra, or else the triangles, and of its magnitude.
struct Integral
{
  double value = 0;
  double magnitude = 0;
};

Integral integrate(vtkPointSet* mesh, const char* name, int component = 0)
{
  vtkDataArray* array = mesh->GetCellData()->GetArray(name);
  Integral integral;
  const int type = cadtest::toMesh(mesh).dimension == 3 ? VTK_TETRA : VTK_TRIANGLE;
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < mesh->GetNumberOfCells(); ++c)
  {
    if (mesh->GetCellType(c) == type)
    {
      mesh->GetCellPoints(c, ids);
      const double held = array->GetComponent(c, component) *
                          (type == VTK_TETRA ? sizeOf<4>(mesh, ids) : sizeOf<3>(mesh, ids));
      integral.value += held;
      integral.magnitude += std::abs(held);
    }
  }
  return integral;
}

void expectSameIntegral(vtkPointSet* mesh, vtkPointSet* before, const char* name, int component = 0)
{
  const Integral was = integrate(before, name, component);
  EXPECT_NEAR(integrate(mesh, name, component).value, was.value, 1e-12 * was.magnitude)
    << name << " " << component;
}

/// Cell arrays Heat, and Flux of three components: anything; Constant: 2.7 and so on; a point array
/// Linear.
void addFields(vtkPointSet* mesh)
{
  std::mt19937 random(5);
  const auto add = [&](const char* name, int components, const auto& valueOf)
  {
    vtkNew<vtkDoubleArray> array;
    array->SetName(name);
    array->SetNumberOfComponents(components);
    array->SetNumberOfTuples(mesh->GetNumberOfCells());
    for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i)
    {
      array->SetValue(i, valueOf());
    }
    mesh->GetCellData()->AddArray(array);
  };
  const auto anything = [&] { return static_cast<double>(random() % 1000) / 300 - 1; };
  add("Heat", 1, anything);
  add("Flux", 3, anything);
  add("Constant", 1, [] { return 2.7; });
  vtkNew<vtkDoubleArray> linear;
  linear->SetName("Linear");
  for (vtkIdType p = 0; p < mesh->GetNumberOfPoints(); ++p)
  {
    linear->InsertNextValue(cadtest::linearAt(mesh->GetPoint(p)));
  }
  mesh->GetPointData()->AddArray(linear);
}

void conserve(vtkMeshAlgorithm* filter)
{
  filter->AddConservedArray("Heat");
  filter->AddConservedArray("Flux");
}

void expectConstant(vtkPointSet* mesh)
{
  double range[2];
  mesh->GetCellData()->GetArray("Constant")->GetRange(range);
  EXPECT_EQ(range[0], 2.7);
  EXPECT_EQ(range[1], 2.7);
}

class ConservedArrays
  : public ParallelTest
  , public testing::WithParamInterface<cadtest::Dealing>
{
protected:
  static double operationsOf(vtkMeshAlgorithm* filter)
  {
    const std::string text = filter->GetRunStatistics();
    const std::string name = "\"local operations\": ";
    const auto place = text.find(name);
    return place == std::string::npos ? 0 : std::stod(text.substr(place + name.size()));
  }

  /// Projected, refined and adapted. At each step the integrals are compared with those before.
  template<class Observe>
  static vtkSmartPointer<vtkPointSet> process(
    const cadtest::FilterRun& filters, vtkPointSet* input, const Observe& observe)
  {
    double operations = 0;
    vtkSmartPointer<vtkPointSet> mesh = input;
    const auto run = [&](auto* example, const auto& configure)
    {
      using Filter = std::remove_pointer_t<decltype(example)>;
      Filter* ran = nullptr;
      const auto next = filters.run<Filter>(mesh,
        [&](Filter* filter)
        {
          conserve(filter);
          filter->SetMinimumQuality(0.6);
          configure(filter);
          ran = filter;
          filter->Register(nullptr);
        });
      operations += operationsOf(ran);
      ran->UnRegister(nullptr);
      observe(next.Get(), mesh.Get());
      mesh = next;
    };
    run(static_cast<vtkProjectOntoCAD*>(nullptr), [](auto*) {});
    run(static_cast<vtkRefineWithCAD*>(nullptr),
      [](auto* filter) { filter->SetMethod(vtkRefineWithCAD::UNIFORM_BISECTION); });
    run(static_cast<vtkAdaptToCAD*>(nullptr),
      [](auto* filter)
      {
        filter->StartProjectedOn();
        filter->SetMaximumSteps(2);
      });
    const vtkIdType cellsBefore = mesh->GetNumberOfCells();
    run(static_cast<vtkCoarsenWithCAD*>(nullptr),
      [](auto* filter)
      {
        filter->SetTargetError(0.1);
        filter->SetMinimumQuality(0.1);
      });
    EXPECT_GT(operations, 10);
    EXPECT_LT(mesh->GetNumberOfCells(), cellsBefore) << "not coarsened";
    return mesh;
  }
};

TEST_P(ConservedArrays, keepTheirIntegralsOnAnyRanks)
{
  const std::string cad = CADREFINE_TRUTH "/box_minus_cylinder.brep";
  const auto whole = cadtest::readGrid(CADREFINE_TRUTH "/box_minus_cylinder_coarse.vtu");
  addFields(whole);
  const auto rankOfCell = cadtest::deal(GetParam(), whole, exchange.size());
  const auto piece = cadtest::pieceOf(whole, rankOfCell, exchange.rank(), false);
  const auto pieces =
    process(cadtest::FilterRun(cad, worldController()), piece, [](vtkPointSet*, vtkPointSet*) {});
  if (exchange.rank() == 0)
  {
    const auto serial = process(cadtest::FilterRun(cad), whole,
      [](vtkPointSet* mesh, vtkPointSet* before)
      {
        expectSameIntegral(mesh, before, "Heat");
        for (int component = 0; component < 3; ++component)
        {
          expectSameIntegral(mesh, before, "Flux", component);
        }
        expectConstant(mesh);
      });
    cadtest::expectSame(exchange, pieces, serial);
  }
  else
  {
    cadtest::expectSame(exchange, pieces, nullptr);
  }
}

INSTANTIATE_TEST_SUITE_P(Dealings, ConservedArrays,
  testing::Values(cadtest::Dealing::Random, cadtest::Dealing::KdTree, cadtest::Dealing::EmptyRank));

/// A cube with vertices inside at random places, whose cells have numbers.
class FieldsUnderOperations : public ParallelTest
{
protected:
  cadtest::TemporaryFolder folder;
  std::string cad = cadtest::writeInto(folder, cadtest::box(1, 1, 1), ".brep");
  vtkSmartPointer<vtkUnstructuredGrid> cube = cadtest::toGrid(cadtest::spoiltCubeMesh(3));

  void SetUp() override { addFields(cube); }

  template<class ValueOf>
  void addTag(const char* name, const ValueOf& valueOf) const
  {
    vtkNew<vtkIntArray> tags;
    tags->SetName(name);
    for (vtkIdType c = 0; c < cube->GetNumberOfCells(); ++c)
    {
      tags->InsertNextValue(valueOf(static_cast<int>(c)));
    }
    cube->GetCellData()->AddArray(tags);
  }

  vtkSmartPointer<vtkPointSet> improved(double minimumQuality = 0.5) const
  {
    const auto piece = cadtest::pieceOf(
      cube, cadtest::deal(cadtest::Dealing::Random, cube, exchange.size()), exchange.rank(), false);
    return cadtest::FilterRun(cad, worldController())
      .run<vtkProjectOntoCAD>(piece,
        [&](vtkProjectOntoCAD* filter)
        {
          filter->AddConservedArray("Heat");
          filter->SetMinimumQuality(minimumQuality);
        });
  }

  /// Over all ranks.
  std::int64_t cellsOf(vtkPointSet* piece) { return exchange.sum(piece->GetNumberOfCells()); }
};

TEST_F(FieldsUnderOperations, stayLinearAndConstant)
{
  const auto mesh = improved();
  EXPECT_NE(cellsOf(mesh), cube->GetNumberOfCells());
  vtkDataArray* linear = mesh->GetPointData()->GetArray("Linear");
  for (vtkIdType p = 0; p < mesh->GetNumberOfPoints(); ++p)
  {
    EXPECT_NEAR(linear->GetTuple1(p), cadtest::linearAt(mesh->GetPoint(p)), 1e-12);
  }
  if (mesh->GetNumberOfCells() > 0)
  {
    expectConstant(mesh);
  }
}

/// Flat sides: the mean is conservative too, but for rounding.
TEST_F(FieldsUnderOperations, ofDensitiesAreMeans)
{
  vtkNew<vtkDoubleArray> copy;
  copy->DeepCopy(cube->GetCellData()->GetArray("Heat"));
  copy->SetName("Other");
  cube->GetCellData()->AddArray(copy);
  const auto mesh = improved();
  for (vtkIdType c = 0; c < mesh->GetNumberOfCells(); ++c)
  {
    EXPECT_NEAR(mesh->GetCellData()->GetArray("Heat")->GetTuple1(c),
      mesh->GetCellData()->GetArray("Other")->GetTuple1(c), 1e-10);
  }
}

/// Numbers of cells do not keep cells apart; groups of cells do.
TEST_F(FieldsUnderOperations, areNotStoppedByNumbersOfCells)
{
  const std::int64_t without = cellsOf(improved());
  addTag("ElementNumber", [](int c) { return 7 * c; });
  EXPECT_EQ(cellsOf(improved()), without);
  addTag("Half", [&](int c) { return c % 2 == 0 ? c : 2 * c + 1; }); // all different, too
  EXPECT_EQ(cellsOf(improved()), without);
  addTag("Pair", [](int c) { return c / 2; }); // no more than half as many
  EXPECT_NE(cellsOf(improved()), without);
}

/// Levels inherit numbers, so that they get fewer than the cells.
TEST_F(FieldsUnderOperations, areNotStoppedByNumbersAfterRefinement)
{
  const auto refined = [&]
  {
    return cellsOf(
      cadtest::FilterRun(cad, worldController())
        .run<vtkAdaptToCAD>(
          cadtest::pieceOf(cube, cadtest::deal(cadtest::Dealing::Random, cube, exchange.size()),
            exchange.rank(), false),
          [](vtkAdaptToCAD* filter)
          {
            filter->SetMethod(vtkAdaptToCAD::UNIFORM_BISECTION);
            filter->SetMinimumQuality(0.4);
            filter->SetMaximumSteps(1);
          }));
  };
  const std::int64_t without = refined();
  addTag("ElementNumber", [](int c) { return c; });
  EXPECT_EQ(refined(), without);
}

TEST_F(FieldsUnderOperations, inThePlaneStayLinearAndConstant)
{
  cad = cadtest::writeInto(folder, cadtest::rectangle(1, 1), ".brep");
  cube = cadtest::toGrid(cadtest::squareMesh(8, 0.2, 3));
  addFields(cube);
  const auto mesh = improved(0.97);
  vtkDataArray* linear = mesh->GetPointData()->GetArray("Linear");
  int unlike = 0;
  for (vtkIdType p = 0; p < mesh->GetNumberOfPoints(); ++p)
  {
    const double value = cadtest::linearAt(mesh->GetPoint(p));
    EXPECT_NEAR(linear->GetTuple1(p), value, 1e-12);
    unlike += value != linear->GetTuple1(p);
  }
  EXPECT_GT(exchange.sum(unlike), 0) << "no vertex has moved";
  if (mesh->GetNumberOfCells() > 0)
  {
    expectConstant(mesh);
  }
}

/// Curved cells hold what the straight ones did: their volumes are integrals of det J, by the
/// quadrature of degree 3 on tetrahedra (P. Keast, 1986).
TEST_F(FieldsUnderOperations, ofQuadraticCellsKeepTheirIntegrals)
{
  if (exchange.rank() > 0)
  {
    return;
  }
  const auto mesh = cadtest::toGrid(cadtest::ballMesh(2, 0.05));
  addFields(mesh);
  const cadtest::FilterRun filters(cadtest::writeInto(folder, cadtest::sphere(2), ".brep"));
  const auto projected = filters.run<vtkProjectOntoCAD>(mesh, conserve);
  const auto curved = filters.run<vtkRefineWithCAD>(projected,
    [](vtkRefineWithCAD* filter)
    {
      conserve(filter);
      filter->SetMethod(vtkRefineWithCAD::UNIFORM_BISECTION);
      filter->QuadraticCellsOn();
    });
  const Integral was = integrate(mesh, "Heat");
  EXPECT_NEAR(cadtest::sizeOf(curved, "Heat"), std::abs(was.value), 1e-12 * was.magnitude);
  EXPECT_GT(cadtest::sizeOf(curved), cadtest::sizeOf(projected) * 1.1);
}

/// In the plane, and on a surface in space.
TEST_F(FieldsUnderOperations, ofTrianglesKeepTheirIntegrals)
{
  const auto expectKept = [&](const Mesh& coarse, const TopoDS_Shape& shape)
  {
    const auto whole = cadtest::toGrid(coarse);
    addFields(whole);
    const std::string file = cadtest::writeInto(folder, shape, ".brep");
    const auto process = [&](const cadtest::FilterRun& filters, vtkPointSet* input)
    {
      const auto projected = filters.run<vtkProjectOntoCAD>(input, conserve);
      return filters.run<vtkRefineWithCAD>(projected,
        [](vtkRefineWithCAD* filter)
        {
          conserve(filter);
          filter->SetLevels(3);
          filter->SetMinimumQuality(0.9);
        });
    };
    const auto piece = cadtest::pieceOf(whole,
      cadtest::deal(cadtest::Dealing::Random, whole, exchange.size()), exchange.rank(), false);
    const auto pieces = process(cadtest::FilterRun(file, worldController()), piece);
    const auto serial = exchange.rank() == 0 ? process(cadtest::FilterRun(file), whole) : nullptr;
    cadtest::expectSame(exchange, pieces, serial);
    if (exchange.rank() == 0)
    {
      expectSameIntegral(serial, whole, "Heat");
      expectSameIntegral(serial, whole, "Flux", 2);
      expectConstant(serial);
      EXPECT_NE(integrate(serial, "Constant").value, integrate(whole, "Constant").value);
    }
  };
  expectKept(cadtest::discMesh(2, 0.05, 8), cadtest::circle(2));
  expectKept(cadtest::sphereMesh(2, 0.05), cadtest::sphere(2));
}

/// Whether the first triangle of every wedge faces out of it.
bool areWedgesAsDocumented(vtkPointSet* mesh)
{
  for (vtkIdType c = 0; c < mesh->GetNumberOfCells(); ++c)
  {
    vtkPoints* points = mesh->GetCell(c)->GetPoints();
    const auto at = [&](int corner)
    {
      Point3 point;
      points->GetPoint(corner, point.data());
      return point;
    };
    if (mesh->GetCellType(c) == VTK_WEDGE &&
        dot(twofoldAreaVector(at(0), at(1), at(2)), at(3) - at(0)) >= 0)
    {
      return false;
    }
  }
  return true;
}

/// Of hexahedra whose sides are not plane, some of which are cut into other cells.
TEST_F(FieldsUnderOperations, ofHexahedraCutIntoOthersKeepTheirIntegrals)
{
  if (exchange.rank() > 0)
  {
    return;
  }
  const auto mesh = cadtest::toGrid(cadtest::hexahedraMesh(4, 0.2, 1));
  addFields(mesh);
  const cadtest::FilterRun filters(cadtest::writeInto(folder, cadtest::sphere(2), ".brep"));
  const auto refined = filters.run<vtkRefineWithCAD>(mesh,
    [](vtkRefineWithCAD* filter)
    {
      conserve(filter);
      filter->SetMarkingArray("Heat");
      filter->SetThreshold(1.5);
      filter->SetLevels(2);
      filter->ProjectNewVerticesOff();
    });
  vtkUnsignedCharArray* types = vtkUnstructuredGrid::SafeDownCast(refined)->GetCellTypesArray();
  for (const int type : { VTK_HEXAHEDRON, VTK_TETRA, VTK_PYRAMID, VTK_WEDGE })
  {
    EXPECT_GT(
      std::count(types->GetPointer(0), types->GetPointer(types->GetNumberOfValues()), type), 0);
  }
  EXPECT_TRUE(areWedgesAsDocumented(vtkPointSet::SafeDownCast(refined)));
  const double held = cadtest::sizeOf(mesh, "Heat");
  EXPECT_NEAR(cadtest::sizeOf(refined, "Heat"), held, 1e-12 * cadtest::sizeOf(mesh));
}

/// Open CASCADE's crank arm: from a mesh of a tenth of its size.
TEST_F(FieldsUnderOperations, ofARealPartKeepTheirIntegrals)
{
  if (exchange.rank() > 0)
  {
    return;
  }
  const auto mesh = cadtest::readGrid(CADREFINE_TRUTH "/crank_arm.vtu");
  addFields(mesh);
  const cadtest::FilterRun filters("/usr/share/opencascade/data/occ/CrankArm.brep");
  const auto projected = filters.run<vtkProjectOntoCAD>(mesh, conserve);
  expectSameIntegral(projected, mesh, "Heat");
  expectConstant(projected);
  const auto adapted = filters.run<vtkAdaptToCAD>(projected,
    [](vtkAdaptToCAD* filter)
    {
      conserve(filter);
      filter->StartProjectedOn();
      filter->SetMaximumSteps(1);
    });
  expectSameIntegral(adapted, mesh, "Heat");
  for (int component = 0; component < 3; ++component)
  {
    expectSameIntegral(adapted, mesh, "Flux", component);
  }
  expectConstant(adapted);
}

} // namespace

} // namespace cadrefine
