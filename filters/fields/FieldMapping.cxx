#include "fields/FieldMapping.h"

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>

#include <utility>

namespace cadrefine
{
namespace
{

/// Takes arrays along one stage of a mapping.
struct Walk
{
  RankExchange& exchange;
  const MeshArrays& arrays;
  const std::vector<std::string>& densities;

  MeshArrays operator()(const ArraySelection& selection) const { return select(arrays, selection); }
  MeshArrays operator()(const Delivery& delivery) const
  {
    return deliver(exchange, arrays, delivery);
  }
  MeshArrays operator()(const RefinementTrace& trace) const
  {
    return refineArrays(arrays, trace, densities);
  }
  MeshArrays operator()(const std::vector<std::array<Index, 2>>& edges) const
  {
    return withMidNodes(arrays, edges);
  }
  MeshArrays operator()(const VertexInterpolation& interpolation) const
  {
    return withInterpolation(exchange, arrays, interpolation);
  }
  MeshArrays operator()(const WeightedRows& rows) const
  {
    return withDensities(arrays, rows, densities);
  }
};

} // namespace

void FieldMapping::convert(ArraySelection selection)
{
  if (selection.points || selection.cells)
  {
    stages_.emplace_back(std::move(selection));
  }
}

void FieldMapping::redistribute(Delivery delivery)
{
  stages_.emplace_back(std::move(delivery));
}

void FieldMapping::refine(RefinementTrace trace)
{
  stages_.emplace_back(std::move(trace));
}

void FieldMapping::interpolate(VertexInterpolation interpolation)
{
  stages_.emplace_back(std::move(interpolation));
}

void FieldMapping::scale(WeightedRows densities)
{
  if (!densities.empty())
  {
    stages_.emplace_back(std::move(densities));
  }
}

void FieldMapping::addMidNodes(std::vector<std::array<Index, 2>> edges)
{
  stages_.emplace_back(std::move(edges));
}

MeshArrays FieldMapping::follow(RankExchange& exchange, MeshArrays arrays, std::size_t done) const
{
  for (; done < stages_.size(); ++done)
  {
    arrays = std::visit(Walk{ exchange, arrays, needs_.densities }, stages_[done]);
  }
  return arrays;
}

} // namespace cadrefine
