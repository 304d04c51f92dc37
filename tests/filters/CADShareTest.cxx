// Of the CAD's faces, edges and vertices each rank draws its share, as one rank draws them.

#include "ParallelTest.h"

#include <vtkCADReader.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <array>
#include <map>
#include <vector>

namespace
{

using namespace cadrefine;

/// Points and normals of all cells of one entity.
using Looks = std::vector<std::array<double, 6>>;

std::map<int, Looks> attributesOf(vtkCADReader* reader, unsigned int part)
{
  auto* const output =
    vtkPartitionedDataSetCollection::SafeDownCast(reader->GetOutputDataObject(0));
  auto* const data = vtkPolyData::SafeDownCast(output->GetPartition(part, 0));
  vtkDataArray* const entities = data->GetCellData()->GetArray("CADEntity");
  vtkDataArray* const normals = data->GetPointData()->GetNormals();
  std::map<int, Looks> looks;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    vtkCell* const cell = data->GetCell(c);
    for (vtkIdType k = 0; k < cell->GetNumberOfPoints(); ++k)
    {
      std::array<double, 6> look{};
      data->GetPoint(cell->GetPointId(k), look.data());
      normals->GetTuple(cell->GetPointId(k), look.data() + 3);
      looks[static_cast<int>(entities->GetComponent(c, 0))].push_back(look);
    }
  }
  return looks;
}

using CADShare = ParallelTest;

TEST_F(CADShare, isDrawnAsByOneRank)
{
  const std::array<vtkMultiProcessController*, 2> controllers{ nullptr, worldController() };
  std::array<vtkNew<vtkCADReader>, 2> readers;
  for (int i = 0; i < 2; ++i)
  {
    readers[i]->SetController(controllers[i]);
    readers[i]->SetFileName(CADREFINE_DATA "/cylinder.brep");
    readers[i]->Update();
  }
  for (unsigned int part = 0; part < 3; ++part)
  {
    std::map<int, Looks> wanted = attributesOf(readers[0], part);
    EXPECT_FALSE(wanted.empty());
    for (auto entity = wanted.begin(); entity != wanted.end();)
    {
      const bool own = entity->first % exchange.size() == exchange.rank();
      entity = own ? std::next(entity) : wanted.erase(entity);
    }
    EXPECT_EQ(attributesOf(readers[1], part), wanted);
  }
}

} // namespace
