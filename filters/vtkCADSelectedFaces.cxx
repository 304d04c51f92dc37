#include "vtkCADSelectedFaces.h"

#include "classification/DistributedBoundary.h"
#include "comm/CollectiveErrors.h"
#include "comm/RankExchange.h"
#include "fields/CADArrays.h"
#include "vtkCADModelCache.h"

#include <cadrefine/cad/model/CADModel.h>
#include <cadrefine/cad/model/EntitySelection.h>

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkTable.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <set>

vtkStandardNewMacro(vtkCADSelectedFaces);
vtkCxxSetObjectMacro(vtkCADSelectedFaces, Controller, vtkMultiProcessController);

namespace
{

using Numbers = std::set<std::int32_t>;

std::vector<vtkDataSet*> DataSetsOf(vtkInformationVector* inputs)
{
  std::vector<vtkDataSet*> result;
  const auto add = [&](vtkDataObject* data)
  {
    if (auto* dataSet = vtkDataSet::SafeDownCast(data))
    {
      result.push_back(dataSet);
    }
  };
  for (int i = 0; i < inputs->GetNumberOfInformationObjects(); ++i)
  {
    vtkDataObject* input = vtkDataObject::GetData(inputs, i);
    add(input);
    if (auto* composite = vtkCompositeDataSet::SafeDownCast(input))
    {
      const auto iterator =
        vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
      for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
      {
        add(iterator->GetCurrentDataObject());
      }
    }
  }
  return result;
}

/// Numbers of the entities of this dimension that the arrays name.
void AddEntities(vtkDataSetAttributes* attributes, int dimension, Numbers& numbers)
{
  vtkDataArray* dimensions = attributes->GetArray(cadrefine::arrays::dimension);
  vtkDataArray* entities = attributes->GetArray(cadrefine::arrays::entity);
  const vtkIdType count = dimensions && entities ? dimensions->GetNumberOfTuples() : 0;
  for (vtkIdType i = 0; i < count; ++i)
  {
    if (dimensions->GetTuple1(i) == dimension)
    {
      numbers.insert(static_cast<std::int32_t>(entities->GetTuple1(i)));
    }
  }
}

/// 1 if the mesh is compared with the edges of the model, 2 if with the faces. Collective.
int FindDimension(
  cadrefine::RankExchange& exchange, vtkPointSet* mesh, const cadrefine::CADModel& model)
{
  int dimension = 0;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells() && dimension < 3; ++cell)
  {
    dimension = std::max(dimension, mesh->GetCell(cell)->GetCellDimension());
  }
  if (exchange.max(dimension) != 2)
  {
    return 2;
  }
  std::vector<cadrefine::Point3> points(mesh->GetNumberOfPoints());
  for (std::size_t p = 0; p < points.size(); ++p)
  {
    mesh->GetPoint(static_cast<vtkIdType>(p), points[p].data());
  }
  return cadrefine::isPlanar(exchange, points, model) ? 1 : 2;
}

/// The numbers of all ranks, on rank 0. Collective.
Numbers GatherNumbers(cadrefine::RankExchange& exchange, const Numbers& mine)
{
  std::vector<std::vector<std::int32_t>> toRank(exchange.size());
  toRank[0].assign(mine.begin(), mine.end());
  Numbers all;
  for (const auto& ofRank : exchange.allToAll(toRank))
  {
    all.insert(ofRank.begin(), ofRank.end());
  }
  return all;
}

} // namespace

vtkCADSelectedFaces::vtkCADSelectedFaces()
{
  this->SetNumberOfInputPorts(3);
  this->SetController(vtkMultiProcessController::GetGlobalController());
}

vtkCADSelectedFaces::~vtkCADSelectedFaces()
{
  this->SetController(nullptr);
}

int vtkCADSelectedFaces::FillInputPortInformation(int port, vtkInformation* info)
{
  constexpr const char* types[3] = { "vtkDataObject", "vtkPartitionedDataSetCollection",
    "vtkPointSet" };
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), types[port]);
  info->Set(vtkAlgorithm::INPUT_IS_REPEATABLE(), port == 0);
  return 1;
}

std::vector<std::string> vtkCADSelectedFaces::Find(
  cadrefine::RankExchange& exchange, vtkInformationVector** inputs)
{
  std::shared_ptr<const cadrefine::CADModel> model;
  cadrefine::agreeOnFailure(
    exchange, [&] { model = vtkCADModelCache::Get(vtkDataObject::GetData(inputs[1])); });
  this->Dimension = FindDimension(exchange, vtkPointSet::GetData(inputs[2]), *model);
  const std::vector<vtkDataSet*> selected = DataSetsOf(inputs[0]);
  Numbers numbers;
  for (vtkDataSet* data : selected)
  {
    AddEntities(data->GetCellData(), this->Dimension, numbers);
  }
  if (!exchange.any(!numbers.empty()))
  {
    for (vtkDataSet* data : selected)
    {
      AddEntities(data->GetPointData(), this->Dimension, numbers);
    }
  }
  std::vector<std::string> entries;
  for (const std::int32_t number : GatherNumbers(exchange, numbers))
  {
    if (number >= 0 && number < model->count(this->Dimension))
    {
      entries.push_back(
        cadrefine::entryOf(*model, { static_cast<std::int8_t>(this->Dimension), number }));
    }
  }
  return entries;
}

int vtkCADSelectedFaces::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->Faces.clear();
  vtkTable* output = vtkTable::GetData(outputs);
  try
  {
    cadrefine::RankExchange exchange(this->Controller);
    cadrefine::runCollectively(exchange,
      [&]
      {
        vtkNew<vtkStringArray> column;
        column->SetName("Faces");
        for (const std::string& entry : this->Find(exchange, inputs))
        {
          column->InsertNextValue(entry);
          this->Faces += entry + "\n";
        }
        output->AddColumn(column);
      });
    return 1;
  }
  catch (...)
  {
    output->Initialize();
    cadrefine::reportOnce(this, this->Controller);
    return 0;
  }
}

void vtkCADSelectedFaces::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Dimension: " << this->Dimension << "\n";
  os << indent << "Faces: " << this->Faces << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
}
