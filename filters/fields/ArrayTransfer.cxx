#include "fields/ArrayTransfer.h"

#include "fields/ArrayRows.h"
#include "fields/CADArrays.h"

#include <cadrefine/base/LargeMemory.h>

#include <vtkAbstractArray.h>
#include <vtkArrayDispatch.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataArrayRange.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>

#include <algorithm>
#include <type_traits>

namespace cadrefine
{
namespace
{

std::string nameOfIds(vtkDataSetAttributes* attributes, const char* otherwise)
{
  vtkDataArray* ids = attributes->GetGlobalIds();
  return ids && ids->GetName() ? ids->GetName() : otherwise;
}

template<class... Lists>
vtkNew<vtkIdTypeArray> makeIds(
  const std::string& name, const ParallelFor& parallelFor, const Lists&... lists)
{
  vtkNew<vtkIdTypeArray> array;
  array->SetName(name.c_str());
  const std::size_t count = (lists.size() + ...);
  array->SetNumberOfValues(static_cast<vtkIdType>(count));
  preferHugePages(array->GetPointer(0), array->GetNumberOfValues() * sizeof(vtkIdType));
  vtkIdType* next = array->GetPointer(0);
  const auto append = [&](const std::vector<GlobalId>& list)
  {
    forEachIndex(parallelFor, list.size(), fineGrain, [&](std::size_t i) { next[i] = list[i]; });
    next += list.size();
  };
  (append(lists), ...);
  return array;
}

/// Whether an array is carried over; ids and ghosts are made anew or not at all.
bool isCarried(vtkDataSetAttributes* attributes, vtkAbstractArray* array)
{
  return array != attributes->GetGlobalIds() &&
         (!array->GetName() ||
           std::string(array->GetName()) != vtkDataSetAttributes::GhostArrayName());
}

/// Adds make(array) for each array that is carried over, as scalars, vectors, ... if it was these.
template<class Make>
void carryOver(vtkDataSetAttributes* source, vtkDataSetAttributes* target, const Make& make)
{
  for (int a = 0; a < source->GetNumberOfArrays(); ++a)
  {
    vtkAbstractArray* array = source->GetAbstractArray(a);
    if (isCarried(source, array))
    {
      addAs(source->IsArrayAnAttribute(a), make(array), target);
    }
  }
}

/// Calls work(from, to) with the arrays in their own type, if it is one of VTK's usual ones. `to`
/// was made like `from`.
template<class Work>
bool inOwnType(vtkAbstractArray* from, vtkAbstractArray* to, const Work& work)
{
  vtkDataArray* source = vtkDataArray::SafeDownCast(from);
  vtkDataArray* target = vtkDataArray::SafeDownCast(to);
  return source && target &&
         vtkArrayDispatch::Dispatch2SameValueType::Execute(source, target, work);
}

template<class Place>
void copy(vtkAbstractArray* from, const std::vector<Place>& places, std::size_t begin,
  std::size_t end, vtkAbstractArray* to)
{
  const auto copyValues = [&](auto* valuesFrom, auto* valuesTo)
  {
    const auto source = vtk::DataArrayValueRange(valuesFrom);
    auto target = vtk::DataArrayValueRange(valuesTo);
    const vtkIdType components = valuesFrom->GetNumberOfComponents();
    auto next = target.begin() + static_cast<vtkIdType>(begin) * components;
    for (std::size_t i = begin; i < end; ++i)
    {
      next = places[i] == noTuple
               ? std::fill_n(next, components, 0)
               : std::copy_n(source.begin() + places[i] * components, components, next);
    }
  };
  if (!inOwnType(from, to, copyValues))
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      if (places[i] != noTuple)
      {
        to->SetTuple(static_cast<vtkIdType>(i), places[i], from);
      }
    }
  }
}

/// The tuples of `array` at these places, which may be noTuple.
template<class Place>
vtkSmartPointer<vtkAbstractArray> gather(vtkAbstractArray* array, const std::vector<Place>& places)
{
  auto result = emptyLike(array, static_cast<vtkIdType>(places.size()));
  copy(array, places, 0, places.size(), result);
  return result;
}

/// The places in these lists, one after the other; nothing where they are those of all `count`
/// tuples in their order.
template<class... Lists>
Places placesIn(vtkIdType count, const Lists&... lists)
{
  vtkIdType next = 0;
  const auto follow = [&](const std::vector<vtkIdType>& list) {
    return std::all_of(list.begin(), list.end(), [&](vtkIdType place) { return place == next++; });
  };
  if ((follow(lists) && ...) && next == count)
  {
    return {};
  }
  std::vector<vtkIdType> places;
  places.reserve((lists.size() + ...));
  (places.insert(places.end(), lists.begin(), lists.end()), ...);
  return places;
}

void selectFrom(vtkDataSetAttributes* source, const Places& places, vtkDataSetAttributes* target)
{
  carryOver(source, target,
    [&](vtkAbstractArray* array)
    { return places ? gather(array, *places) : vtkSmartPointer<vtkAbstractArray>(array); });
}

template<class Value>
Value middle(Value a, Value b)
{
  if constexpr (std::is_floating_point_v<Value>)
  {
    return static_cast<Value>(0.5 * a + 0.5 * b);
  }
  else
  {
    return a;
  }
}

/// The tuples of the old vertices, then those of the middles of edges; of vertices with rows, by
/// these.
vtkSmartPointer<vtkAbstractArray> interpolate(vtkAbstractArray* array,
  const std::vector<std::array<Index, 2>>& parentEdges, const WeightedRows& rows = {})
{
  const vtkIdType oldCount = array->GetNumberOfTuples();
  const auto newCount = static_cast<vtkIdType>(parentEdges.size());
  auto result = emptyLike(array, oldCount + newCount);
  result->InsertTuples(0, oldCount, 0, array);
  std::vector<Index> betweenEnds; // new ones without a row
  auto row = applyRows(array, rows, Sums::WithinValues, result)
               ? std::lower_bound(rows.targets.begin(), rows.targets.end(), oldCount)
               : rows.targets.end();
  reserveLong(betweenEnds, parentEdges.size());
  for (Index n = 0; n < newCount; ++n)
  {
    row != rows.targets.end() && *row == oldCount + n ? void(++row) : betweenEnds.push_back(n);
  }
  const auto fill = [&](auto* from, auto* to)
  {
    auto target = vtk::DataArrayValueRange(to);
    const vtkIdType components = from->GetNumberOfComponents();
    const auto at = [&](vtkIdType tuple) { return target.begin() + tuple * components; };
    using Value = vtk::GetAPIType<std::remove_pointer_t<decltype(from)>>;
    for (const Index n : betweenEnds)
    {
      const auto& [a, b] = parentEdges[n];
      std::transform(at(a), at(a) + components, at(b), at(oldCount + n), middle<Value>);
    }
  };
  if (!inOwnType(array, result, fill))
  {
    for (const Index n : betweenEnds)
    {
      result->SetTuple(oldCount + n, parentEdges[n][0], result);
    }
  }
  return result;
}

/// The cell that each child is a part of, cells of dimension 0 first.
std::vector<Index> parentCells(const RefinementTrace& trace)
{
  std::size_t children = 0;
  for (const auto& firsts : trace.firstChildren)
  {
    children += firsts.back();
  }
  std::vector<Index> parents;
  resizeLong(parents, children);
  auto first = parents.begin();
  Index firstCell = 0;
  for (int d = 0; d < 4; ++d)
  {
    trace.visitChildren(d, [&](Index cell, Index child) { first[child] = firstCell + cell; });
    first += trace.firstChildren[d].back();
    firstCell += static_cast<Index>(trace.firstChildren[d].size()) - 1;
  }
  return parents;
}

bool isIn(const std::vector<std::string>& names, vtkAbstractArray* array)
{
  return array->GetName() && std::find(names.begin(), names.end(), array->GetName()) != names.end();
}

MeshArrays emptyArrays(const std::string& vertexIdName, const std::string& cellIdName)
{
  return { vtkSmartPointer<vtkPointData>::New(), vtkSmartPointer<vtkCellData>::New(),
    vtkSmartPointer<vtkFieldData>::New(), vertexIdName, cellIdName };
}

std::vector<vtkAbstractArray*> arraysWithoutNames(vtkDataSetAttributes* attributes)
{
  std::vector<vtkAbstractArray*> arrays;
  for (int a = 0; a < attributes->GetNumberOfArrays(); ++a)
  {
    vtkAbstractArray* array = attributes->GetAbstractArray(a);
    if (!array->GetName() || *array->GetName() == 0)
    {
      arrays.push_back(array);
    }
  }
  return arrays;
}

} // namespace

vtkSmartPointer<vtkAbstractArray> emptyLike(vtkAbstractArray* array, vtkIdType count)
{
  auto result = vtkSmartPointer<vtkAbstractArray>::Take(array->NewInstance());
  result->SetName(array->GetName());
  result->SetNumberOfComponents(array->GetNumberOfComponents());
  result->CopyComponentNames(array);
  result->SetNumberOfTuples(count);
  if (vtkDataArray::SafeDownCast(result))
  {
    preferHugePages(result->GetVoidPointer(0),
      static_cast<std::size_t>(result->GetNumberOfValues()) * result->GetDataTypeSize());
  }
  return result;
}

vtkAbstractArray* arrayLike(
  vtkDataSetAttributes* attributes, int index, vtkDataSetAttributes* other)
{
  vtkAbstractArray* array = attributes->GetAbstractArray(index);
  const auto mine = arraysWithoutNames(attributes);
  const auto there = arraysWithoutNames(other);
  const auto place =
    static_cast<std::size_t>(std::find(mine.begin(), mine.end(), array) - mine.begin());
  vtkAbstractArray* found = place == mine.size()   ? other->GetAbstractArray(array->GetName())
                            : place < there.size() ? there[place]
                                                   : nullptr;
  const bool isAlike = found && found->GetDataType() == array->GetDataType() &&
                       found->GetNumberOfComponents() == array->GetNumberOfComponents();
  return isAlike ? found : nullptr;
}

void copyTuples(vtkAbstractArray* from, const std::vector<vtkIdType>& places, std::size_t begin,
  std::size_t end, vtkAbstractArray* to)
{
  copy(from, places, begin, end, to);
}

void addAs(int attribute, vtkAbstractArray* array, vtkDataSetAttributes* target)
{
  const int added = target->AddArray(array);
  if (attribute >= 0)
  {
    target->SetActiveAttribute(added, attribute);
  }
}

MeshArrays arraysOf(vtkPointSet* input)
{
  MeshArrays arrays = emptyArrays(nameOfIds(input->GetPointData(), "GlobalPointIds"),
    nameOfIds(input->GetCellData(), "GlobalCellIds"));
  selectFrom(input->GetPointData(), {}, arrays.ofVertices);
  if (input->GetNumberOfCells() > 0)
  {
    selectFrom(input->GetCellData(), {}, arrays.ofCells);
  }
  arrays.ofMesh->PassData(input->GetFieldData());
  return arrays;
}

ArraySelection selectionOf(vtkPointSet* input, const ConvertedMesh& mesh)
{
  ArraySelection selection;
  selection.points = placesIn(input->GetNumberOfPoints(), mesh.pointOf);
  if (input->GetNumberOfCells() > 0)
  {
    const auto& cells = mesh.cellOf;
    selection.cells = placesIn(input->GetNumberOfCells(), cells[0], cells[1], cells[2], cells[3]);
  }
  return selection;
}

MeshArrays select(const MeshArrays& arrays, const ArraySelection& selection)
{
  MeshArrays result = emptyArrays(arrays.vertexIdName, arrays.cellIdName);
  selectFrom(arrays.ofVertices, selection.points, result.ofVertices);
  selectFrom(arrays.ofCells, selection.cells, result.ofCells);
  result.ofMesh = arrays.ofMesh;
  return result;
}

MeshArrays refineArrays(
  const MeshArrays& coarse, const RefinementTrace& trace, const std::vector<std::string>& densities)
{
  MeshArrays fine = emptyArrays(coarse.vertexIdName, coarse.cellIdName);
  carryOver(coarse.ofVertices, fine.ofVertices,
    [&](vtkAbstractArray* array)
    { return interpolate(array, trace.parentEdges, trace.ofVertices); });
  const auto parents =
    coarse.ofCells->GetNumberOfArrays() > 0 ? parentCells(trace) : std::vector<Index>{};
  carryOver(coarse.ofCells, fine.ofCells,
    [&](vtkAbstractArray* array)
    {
      auto result = gather(array, parents);
      if (isMeasured(array->GetName()))
      {
        return result;
      }
      isIn(densities, array) ? applyRows(array, trace.ofDensities, Sums::AsTheyAre, result)
                             : applyRows(array, trace.ofCells, Sums::WithinValues, result);
      return result;
    });
  fine.ofMesh = coarse.ofMesh;
  return fine;
}

MeshArrays withVertexRows(const MeshArrays& arrays, const WeightedRows& rows)
{
  MeshArrays result = emptyArrays(arrays.vertexIdName, arrays.cellIdName);
  carryOver(arrays.ofVertices, result.ofVertices,
    [&](vtkAbstractArray* array)
    {
      return isReal(array) ? interpolate(array, {}, rows)
                           : vtkSmartPointer<vtkAbstractArray>(array);
    });
  result.ofCells = arrays.ofCells;
  result.ofMesh = arrays.ofMesh;
  return result;
}

MeshArrays withDensities(
  const MeshArrays& arrays, const WeightedRows& rows, const std::vector<std::string>& densities)
{
  MeshArrays result = emptyArrays(arrays.vertexIdName, arrays.cellIdName);
  carryOver(arrays.ofCells, result.ofCells,
    [&](vtkAbstractArray* array) -> vtkSmartPointer<vtkAbstractArray>
    {
      if (!isIn(densities, array))
      {
        return array;
      }
      auto changed = vtkSmartPointer<vtkAbstractArray>::Take(array->NewInstance());
      changed->DeepCopy(array);
      applyRows(array, rows, Sums::AsTheyAre, changed);
      return changed;
    });
  result.ofVertices = arrays.ofVertices;
  result.ofMesh = arrays.ofMesh;
  return result;
}

MeshArrays withMidNodes(
  const MeshArrays& arrays, const std::vector<std::array<Index, 2>>& parentEdges)
{
  MeshArrays result = emptyArrays(arrays.vertexIdName, arrays.cellIdName);
  carryOver(arrays.ofVertices, result.ofVertices,
    [&](vtkAbstractArray* array) { return interpolate(array, parentEdges); });
  result.ofCells = arrays.ofCells;
  result.ofMesh = arrays.ofMesh;
  return result;
}

void setArrays(const MeshArrays& arrays, const ConvertedMesh& mesh, vtkPointSet* output,
  const ParallelFor& parallelFor)
{
  const auto pass = [](vtkAbstractArray* array) { return array; };
  carryOver(arrays.ofVertices, output->GetPointData(), pass);
  carryOver(arrays.ofCells, output->GetCellData(), pass);
  output->GetFieldData()->PassData(arrays.ofMesh);
  const std::vector<GlobalId> ofNodes =
    mesh.midNodes ? mesh.midNodes->ids : std::vector<GlobalId>();
  output->GetPointData()->SetGlobalIds(
    makeIds(arrays.vertexIdName, parallelFor, mesh.mesh.ids, ofNodes));
  const auto& cells = mesh.cellIds;
  output->GetCellData()->SetGlobalIds(
    makeIds(arrays.cellIdName, parallelFor, cells[0], cells[1], cells[2], cells[3]));
}

} // namespace cadrefine
