#include "BadMesh.h"

#include "DataSets.h"
#include "TestMeshes.h"

#include <vtkCADBoundary.h>

namespace cadrefine
{
namespace
{

template<class Filter>
cadtest::Outcome attemptFilter(const cadtest::FilterRun& filters, vtkPointSet* mesh)
{
  return filters.attempt<Filter>(mesh, [](Filter*) {});
}

cadtest::Outcome attemptAdapt(const cadtest::FilterRun& filters, vtkPointSet* mesh)
{
  return filters.attempt<vtkAdaptToCAD>(
    mesh, [](vtkAdaptToCAD* filter) { filter->SetMaximumSteps(1); });
}

} // namespace

const std::vector<NamedFilter>& BadMesh::allFilters()
{
  static const std::vector<NamedFilter> filters{
    { "Project Onto CAD", attemptFilter<vtkProjectOntoCAD> },
    { "Adapt To CAD", attemptAdapt },
    { "Mesh Validity", attemptFilter<vtkMeshValidity> },
    { "CAD Geometric Error", attemptFilter<vtkCADGeometricError> },
    { "CAD Boundary", attemptFilter<vtkCADBoundary> },
    { "Refine With CAD", attemptFilter<vtkRefineWithCAD> },
  };
  return filters;
}

std::vector<NamedFilter> BadMesh::filtersOfRawMeshes()
{
  return { allFilters().begin(), allFilters().begin() + 3 };
}

std::vector<NamedFilter> BadMesh::filtersOfProjectedMeshes()
{
  return { allFilters().begin() + 3, allFilters().end() };
}

BadMesh::Grid BadMesh::ball()
{
  return cadtest::toGrid(cadtest::ballMesh(2, 0.03));
}

vtkSmartPointer<vtkPointSet> BadMesh::pieceOf(vtkPointSet* whole) const
{
  return cadtest::pieceOf(
    whole, cadtest::deal(cadtest::Dealing::Blocks, whole, exchange.size()), exchange.rank(), false);
}

vtkSmartPointer<vtkPointSet> BadMesh::allOn(int rank, vtkPointSet* whole) const
{
  const std::vector<int> ranks(static_cast<std::size_t>(whole->GetNumberOfCells()), rank);
  return cadtest::pieceOf(whole, ranks, exchange.rank(), false);
}

void BadMesh::expectError(const cadtest::Outcome& outcome, const std::string& text) const
{
  EXPECT_FALSE(outcome.succeeded);
  EXPECT_EQ(outcome.pointSet()->GetNumberOfPoints(), 0);
  EXPECT_EQ(outcome.pointSet()->GetNumberOfCells(), 0);
  EXPECT_EQ(outcome.errors.size(), exchange.rank() == 0 ? 1u : 0u);
  if (!outcome.errors.empty())
  {
    EXPECT_NE(outcome.errors[0].find(text), std::string::npos) << outcome.errors[0];
  }
}

void BadMesh::expectErrors(
  const std::vector<NamedFilter>& which, vtkPointSet* mesh, const std::string& text) const
{
  for (const NamedFilter& filter : which)
  {
    SCOPED_TRACE(filter.name);
    expectError(filter.attempt(filters, mesh), text);
  }
}

void BadMesh::expectLimitOfCoordinates(const Grid& grid) const
{
  if (isLast())
  {
    grid->GetPoints()->SetPoint(5, 1, 1e300, 0);
  }
  expectErrors(allFilters(), grid, "beyond 1.5e51 (point 5)");
  if (isLast())
  {
    grid->GetPoints()->SetPoint(5, 1, 1e50, 0);
  }
  for (const NamedFilter& filter : filtersOfRawMeshes())
  {
    const cadtest::Outcome outcome = filter.attempt(filters, grid);
    EXPECT_TRUE(outcome.succeeded) << filter.name << testing::PrintToString(outcome.errors);
  }
}

void BadMesh::expectSame(
  const std::vector<NamedFilter>& which, vtkPointSet* piece, vtkPointSet* whole)
{
  const cadtest::FilterRun alone(filters.cad());
  for (const NamedFilter& filter : which)
  {
    SCOPED_TRACE(filter.name);
    const cadtest::Outcome outcome = filter.attempt(filters, piece);
    EXPECT_TRUE(outcome.succeeded);
    const cadtest::Outcome expected =
      exchange.rank() == 0 ? filter.attempt(alone, whole) : cadtest::Outcome();
    EXPECT_TRUE(exchange.rank() > 0 || expected.succeeded);
    expectSameMesh(outcome.pointSet(), expected.pointSet(), filter.name);
  }
}

void BadMesh::expectSameMesh(vtkPointSet* piece, vtkPointSet* whole, const std::string& what)
{
  const cadtest::CanonicalMesh mesh = cadtest::gather(exchange, piece);
  if (exchange.rank() > 0)
  {
    return;
  }
  RankExchange alone(nullptr);
  const cadtest::CanonicalMesh expected = cadtest::gather(alone, whole);
  EXPECT_EQ(mesh.contradictions, 0) << what;
  EXPECT_FALSE(expected.cells.empty()) << what;
  EXPECT_TRUE(mesh.points == expected.points) << what;
  EXPECT_TRUE(mesh.cells == expected.cells) << what;
}

} // namespace cadrefine
