#include "ArrayDelivery.h"

#include "Agreement.h"
#include "ArrayBytes.h"

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkTable.h>

namespace cadrefine
{
namespace
{

using Bytes = std::vector<char>;

Bytes pack(vtkDataSetAttributes* attributes)
{
  return attributes->GetNumberOfTuples() == 0 ? Bytes() : bytesOf(attributes);
}

/// The tuples of all tables in a row.
void append(const std::vector<vtkSmartPointer<vtkTable>>& tables, vtkDataSetAttributes* attributes)
{
  if (tables.empty())
  {
    return;
  }
  vtkDataSetAttributes::FieldList fields;
  vtkIdType total = 0;
  for (const auto& table : tables)
  {
    fields.IntersectFieldList(table->GetRowData());
    total += table->GetNumberOfRows();
  }
  attributes->CopyAllOn();
  attributes->CopyAllocate(fields, total);
  attributes->SetNumberOfTuples(total);
  vtkIdType next = 0;
  for (std::size_t t = 0; t < tables.size(); ++t)
  {
    const vtkIdType rows = tables[t]->GetNumberOfRows();
    attributes->CopyData(fields, tables[t]->GetRowData(), static_cast<int>(t), next, rows, 0);
    next += rows;
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
  attempt(exchange,
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
  attempt(exchange,
    [&]
    {
      unpack(ofVertices, result.ofVertices);
      unpack(ofCells, result.ofCells);
    });
  return result;
}

} // namespace cadrefine
