// Cells on their way to other ranks.
#pragma once

#include "fields/ArrayDelivery.h"
#include "mesh/DistributedMesh.h"

#include <cstddef>
#include <vector>

namespace cadrefine
{

/// A mesh whose cells went to other ranks, and what belongs to it.
struct Redistribution
{
  DistributedMesh mesh;
  Delivery delivery; ///< What went where.

  /// The values of this rank's vertices, given those of its vertices before. Collective; every
  /// value is sent once.
  template<class T>
  std::vector<T> ofVertices(RankExchange& exchange, const std::vector<T>& values) const
  {
    return send(exchange, values, &ArraySelection::points, delivery.points);
  }
  /// The values of this rank's cells, given those of its cells before, both in the order of
  /// makePointSet. Collective; every value is sent once.
  template<class T>
  std::vector<T> ofCells(RankExchange& exchange, const std::vector<T>& values) const
  {
    return send(exchange, values, &ArraySelection::cells, delivery.cells);
  }

private:
  template<class T>
  std::vector<T> send(RankExchange& exchange, const std::vector<T>& values,
    Places ArraySelection::*places, const std::vector<std::size_t>& counts) const;
};

/// Sends the cells to these ranks, given in the order of makePointSet: every cell is sent once. The
/// mesh has to be of first order. Collective. Messages: three to each rank that gets cells, of 32
/// bytes a vertex and of 8 bytes and 4 a corner a cell, and those of findSharedVertices of the
/// vertices that were shared or are of cells that went. Work: linear in the piece, which stays in
/// its memory but for what comes.
///
/// vtkRedistributeDataSetFilter knows no weights, and loses cells in silence where libexpat has the
/// corrections of 2024 (Debian 12: 2.5.0-1+deb12u2): VTK 9.2 sends data sets as XML that this
/// library refuses (that of ParaView 5.13 does not).
Redistribution redistribute(
  RankExchange& exchange, DistributedMesh mesh, const std::vector<int>& ranks);

template<class T>
std::vector<T> Redistribution::send(RankExchange& exchange, const std::vector<T>& values,
  Places ArraySelection::*places, const std::vector<std::size_t>& counts) const
{
  const auto here = static_cast<std::size_t>(exchange.rank());
  const auto& toRanks = delivery.toRanks;
  const auto placesTo = [&](std::size_t rank) -> const std::vector<vtkIdType>&
  { return *(toRanks[rank].*places); };
  std::vector<std::vector<T>> parts(toRanks.size());
  for (std::size_t rank = 0; rank < toRanks.size(); ++rank)
  {
    for (const vtkIdType place : rank == here ? std::vector<vtkIdType>() : placesTo(rank))
    {
      parts[rank].push_back(values[place]);
    }
  }
  parts = exchange.allToAll(parts);
  const std::vector<vtkIdType>& kept = *(delivery.kept.*places);
  std::vector<T> result(kept.size());
  forKept(kept, counts,
    [&](std::size_t rank, vtkIdType place, std::size_t k)
    { result[k] = rank == here ? values[placesTo(here)[place]] : parts[rank][place]; });
  return result;
}

} // namespace cadrefine
