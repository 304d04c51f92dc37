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
vtkAbstractArray* arrayLike(vtkAbstractArray* array, vtkDataSetAttributes* attributes)
{
  vtkAbstractArray* other =
    array->GetName() ? attributes->GetAbstractArray(array->GetName()) : nullptr;
  return other && other->GetDataType() == array->GetDataType() &&
             other->GetNumberOfComponents() == array->GetNumberOfComponents()
           ? other
           : nullptr;
}

/// The tuples of all parts in a row, of the arrays that all have.
void append(const std::vector<vtkDataSetAttributes*>& parts, vtkDataSetAttributes* attributes)
{
  if (parts.size() == 1)
  {
    attributes->ShallowCopy(parts.front());
  }
  if (parts.size() <= 1)
  {
    return;
  }
  const vtkIdType total = std::accumulate(parts.begin(), parts.end(), vtkIdType{ 0 },
    [](vtkIdType sum, vtkDataSetAttributes* part) { return sum + part->GetNumberOfTuples(); });
  vtkDataSetAttributes* first = parts.front();
  for (int a = 0; a < first->GetNumberOfArrays(); ++a)
  {
    vtkAbstractArray* array = first->GetAbstractArray(a);
    if (!std::all_of(parts.begin(), parts.end(),
          [&](vtkDataSetAttributes* part) { return arrayLike(array, part); }))
    {
      continue;
    }
    const auto all = emptyLike(array, total);
    vtkIdType next = 0;
    for (vtkDataSetAttributes* part : parts)
    {
      all->InsertTuples(next, part->GetNumberOfTuples(), 0, arrayLike(array, part));
      next += part->GetNumberOfTuples();
    }
    addAs(first->IsArrayAnAttribute(a), all, attributes);
  }
}

/// `own`: in the place of what comes from this rank.
void unpack(const std::vector<Bytes>& incoming, int rank, vtkDataSetAttributes* own,
  vtkDataSetAttributes* attributes)
{
  std::vector<vtkSmartPointer<vtkTable>> tables;
  std::vector<vtkDataSetAttributes*> parts;
  for (int r = 0; r < static_cast<int>(incoming.size()); ++r)
  {
    if (r == rank && own->GetNumberOfTuples() > 0)
    {
      parts.push_back(own);
    }
    else if (!incoming[r].empty())
    {
      tables.push_back(arraysOf(incoming[r]));
      parts.push_back(tables.back()->GetRowData());
    }
  }
  append(parts, attributes);
}

/// A rank that had no points does not know how the arrays of ids are called elsewhere.
void agreeOnNamesOfIds(RankExchange& exchange, MeshArrays& arrays)
{
  const auto agree = [&](std::string& name)
  {
    const int root =
      static_cast<int>(exchange.min(name.empty() ? exchange.size() - 1 : exchange.rank()));
    const std::vector<char> text = exchange.broadcast({ name.begin(), name.end() }, root);
    name.assign(text.begin(), text.end());
  };
  agree(arrays.vertexIdName);
  agree(arrays.cellIdName);
}

} // namespace

MeshArrays deliver(RankExchange& exchange, const MeshArrays& arrays, const Delivery& delivery)
{
  const auto here = static_cast<std::size_t>(exchange.rank());
  std::vector<Bytes> ofVertices(delivery.size());
  std::vector<Bytes> ofCells(delivery.size());
  MeshArrays own;
  agreeOnFailure(exchange,
    [&]
    {
      own = select(arrays, delivery[here]);
      for (std::size_t rank = 0; rank < delivery.size(); ++rank)
      {
        if (rank != here)
        {
          const MeshArrays part = select(arrays, delivery[rank]);
          ofVertices[rank] = pack(part.ofVertices);
          ofCells[rank] = pack(part.ofCells);
        }
      }
    });
  ofVertices = exchange.allToAll(ofVertices);
  ofCells = exchange.allToAll(ofCells);
  MeshArrays result{ vtkSmartPointer<vtkPointData>::New(), vtkSmartPointer<vtkCellData>::New(),
    arrays.ofMesh, arrays.vertexIdName, arrays.cellIdName };
  agreeOnNamesOfIds(exchange, result);
  agreeOnFailure(exchange,
    [&]
    {
      unpack(ofVertices, exchange.rank(), own.ofVertices, result.ofVertices);
      unpack(ofCells, exchange.rank(), own.ofCells, result.ofCells);
    });
  return result;
}

} // namespace cadrefine
