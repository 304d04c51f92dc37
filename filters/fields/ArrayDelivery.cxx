#include "fields/ArrayDelivery.h"

#include "comm/CollectiveErrors.h"
#include "fields/ArrayBytes.h"

#include <cadrefine/base/LargeMemory.h>

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkTable.h>

#include <algorithm>

namespace cadrefine
{
namespace
{

using Bytes = std::vector<char>;

Bytes pack(vtkDataSetAttributes* attributes)
{
  return attributes->GetNumberOfTuples() == 0 ? Bytes() : bytesOf(attributes);
}

/// What came from a rank: all of these arrays, or their tuples at these places.
struct Part
{
  vtkDataSetAttributes* attributes = nullptr; ///< Null: it had no arrays, or nothing came.
  const std::vector<vtkIdType>* places = nullptr;
};

/// Tuples of one part that follow each other.
struct Run
{
  std::size_t part;
  std::size_t begin;
};

/// Gathers the kept tuples of a row of parts, given how many each has, for the arrays that all
/// parts have from which something came.
void gatherKept(const std::vector<Part>& parts, const std::vector<std::size_t>& counts,
  const std::vector<vtkIdType>& kept, vtkDataSetAttributes* attributes)
{
  const auto first =
    std::find_if(counts.begin(), counts.end(), [](std::size_t count) { return count > 0; });
  vtkDataSetAttributes* model =
    first == counts.end() ? nullptr : parts[first - counts.begin()].attributes;
  if (!model)
  {
    return;
  }
  std::vector<vtkIdType> places; // in their parts' arrays
  resizeLong(places, kept.size());
  std::vector<Run> runs;
  forKept(kept, counts,
    [&](std::size_t part, vtkIdType place, std::size_t k)
    {
      places[k] = parts[part].places ? (*parts[part].places)[place] : place;
      if (runs.empty() || runs.back().part != part)
      {
        runs.push_back({ part, k });
      }
    });
  runs.push_back({ parts.size(), kept.size() });
  for (int a = 0; a < model->GetNumberOfArrays(); ++a)
  {
    vtkAbstractArray* array = model->GetAbstractArray(a);
    std::vector<vtkAbstractArray*> sources;
    bool allHaveIt = true;
    for (std::size_t p = 0; p < parts.size(); ++p)
    {
      vtkDataSetAttributes* part = parts[p].attributes;
      sources.push_back(part ? arrayLike(model, a, part) : nullptr);
      allHaveIt = allHaveIt && (counts[p] == 0 || sources.back());
    }
    if (allHaveIt)
    {
      const auto all = emptyLike(array, static_cast<vtkIdType>(kept.size()));
      for (std::size_t r = 0; r + 1 < runs.size(); ++r)
      {
        copyTuples(sources[runs[r].part], places, runs[r].begin, runs[r + 1].begin, all);
      }
      addAs(model->IsArrayAnAttribute(a), all, attributes);
    }
  }
}

/// What came from each rank, `own` in the place of what comes from this one.
std::vector<Part> unpack(const std::vector<Bytes>& incoming, std::size_t here, const Part& own,
  std::vector<vtkSmartPointer<vtkTable>>& tables)
{
  std::vector<Part> parts(incoming.size());
  for (std::size_t rank = 0; rank < incoming.size(); ++rank)
  {
    if (!incoming[rank].empty())
    {
      tables.push_back(arraysOf(incoming[rank]));
      parts[rank].attributes = tables.back()->GetRowData();
    }
  }
  parts[here] = own;
  return parts;
}

/// Makes the names of the arrays of ids the same on all ranks: one that had no points does not know
/// what they are called elsewhere.
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
  const auto& toRanks = delivery.toRanks;
  std::vector<Bytes> ofVertices(toRanks.size());
  std::vector<Bytes> ofCells(toRanks.size());
  agreeOnFailure(exchange,
    [&]
    {
      for (std::size_t rank = 0; rank < toRanks.size(); ++rank)
      {
        if (rank != here)
        {
          const MeshArrays part = select(arrays, toRanks[rank]);
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
      const MeshArrays own = select(arrays, {});
      std::vector<vtkSmartPointer<vtkTable>> tables;
      gatherKept(unpack(ofVertices, here, { own.ofVertices, &*toRanks[here].points }, tables),
        delivery.points, *delivery.kept.points, result.ofVertices);
      gatherKept(unpack(ofCells, here, { own.ofCells, &*toRanks[here].cells }, tables),
        delivery.cells, *delivery.kept.cells, result.ofCells);
    });
  return result;
}

} // namespace cadrefine
