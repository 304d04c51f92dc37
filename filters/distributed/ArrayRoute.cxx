#include "ArrayRoute.h"

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace cadrefine
{
namespace
{

/// A step of the way.
struct Walk
{
  RankExchange& exchange;
  const MeshArrays& arrays;

  MeshArrays operator()(const ArraySelection& selection) const { return select(arrays, selection); }
  MeshArrays operator()(const Delivery& delivery) const
  {
    return deliver(exchange, arrays, delivery);
  }
  MeshArrays operator()(const RefinementTrace& trace) const
  {
    return refineArrays(arrays, trace.parentEdges, trace.firstChildren);
  }
  MeshArrays operator()(const std::vector<std::array<Index, 2>>& edges) const
  {
    return withMidNodes(arrays, edges);
  }
};

} // namespace

void ArrayRoute::convert(vtkPointSet* input, const ConvertedMesh& mesh)
{
  ArraySelection selection = selectionOf(input, mesh);
  if (selection.points || selection.cells)
  {
    legs_.emplace_back(std::move(selection));
  }
}

void ArrayRoute::redistribute(Delivery delivery)
{
  legs_.emplace_back(std::move(delivery));
}

void ArrayRoute::refine(RefinementTrace trace)
{
  legs_.emplace_back(std::move(trace));
}

void ArrayRoute::addMidNodes(std::vector<std::array<Index, 2>> edges)
{
  legs_.emplace_back(std::move(edges));
}

void ArrayRoute::append(ArrayRoute next)
{
  std::move(next.legs_.begin(), next.legs_.end(), std::back_inserter(legs_));
}

MeshArrays ArrayRoute::follow(RankExchange& exchange, MeshArrays arrays) const
{
  for (const Leg& leg : legs_)
  {
    arrays = std::visit(Walk{ exchange, arrays }, leg);
  }
  return arrays;
}

} // namespace cadrefine
