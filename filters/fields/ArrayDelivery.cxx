#include "fields/ArrayDelivery.h"

#include "comm/CollectiveErrors.h"
#include "fields/ArrayBytes.h"

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkTable.h>

#include <algorithm>
#include <numeric>

namespace cadrefine
{
namespace
{

using Bytes = std::vector<char>;

Bytes pack(vtkDataSetAttributes* attributes)
{
  return attributes->GetNumberOfTuples() == 0 ? Bytes() : bytesOf(attributes);
}

/// The array of that name, type and number of components; null where there is none.
vtkAbstractArray* arrayLike(vtkAbstractArray* array, vtkTable* table)
{
  vtkAbstractArray* other =
    array->GetName() ? table->GetRowData()->GetAbstractArray(array->GetName()) : nullptr;
  return other && other->GetDataType() == array->GetDataType() &&
             other->GetNumberOfComponents() == array->GetNumberOfComponents()
           ? other
           : nullptr;
}

/// The tuples of all tables in a row, of the arrays that all have.
void append(const std::vector<vtkSmartPointer<vtkTable>>& tables, vtkDataSetAttributes* attributes)
{
  if (tables.empty())
  {
    return;
  }
  const vtkIdType total = std::accumulate(tables.begin(), tables.end(), vtkIdType{ 0 },
    [](vtkIdType sum, vtkTable* table) { return sum + table->GetNumberOfRows(); });
  vtkDataSetAttributes* first = tables.front()->GetRowData();
  for (int a = 0; a < first->GetNumberOfArrays(); ++a)
  {
    vtkAbstractArray* array = first->GetAbstractArray(a);
    if (!std::all_of(
          tables.begin(), tables.end(), [&](vtkTable* table) { return arrayLike(array, table); }))
    {
      continue;
    }
    const auto all = emptyLike(array, total);
    vtkIdType next = 0;
    for (vtkTable* table : tables)
    {
      all->InsertTuples(next, table->GetNumberOfRows(), 0, arrayLike(array, table));
      next += table->GetNumberOfRows();
    }
    addAs(first->IsArrayAnAttribute(a), all, attributes);
  }
}

void unpack(const std::vector<Bytes>& incoming, vtkDataSetAttributes* attributes)
{
  std::vector<vtkSmartPointer<vtkTable>> tables;
  for (const Bytes& bytes : incoming)
  {
    if (!bytes.empty())
    {
      tables.push_back(arraysOf(bytes));
    }
  }
  append(tables, attributes);
}

} // namespace

MeshArrays deliver(RankExchange& exchange, const MeshArrays& arrays, const Delivery& delivery)
{
  std::vector<Bytes> ofVertices(delivery.size());
  std::vector<Bytes> ofCells(delivery.size());
  agreeOnFailure(exchange,
    [&]
    {
      for (std::size_t rank = 0; rank < delivery.size(); ++rank)
      {
        const MeshArrays part = select(arrays, delivery[rank]);
        ofVertices[rank] = pack(part.ofVertices);
        ofCells[rank] = pack(part.ofCells);
      }
    });
  ofVertices = exchange.allToAll(ofVertices);
  ofCells = exchange.allToAll(ofCells);
  MeshArrays result{ vtkSmartPointer<vtkPointData>::New(), vtkSmartPointer<vtkCellData>::New(),
    arrays.ofMesh, arrays.vertexIdName, arrays.cellIdName };
  agreeOnFailure(exchange,
    [&]
    {
      unpack(ofVertices, result.ofVertices);
      unpack(ofCells, result.ofCells);
    });
  return result;
}

} // namespace cadrefine
