#include "classification/CornerAssignment.h"

#include <cadrefine/classification/CADAdjacency.h>
#include <cadrefine/classification/ClassificationTolerances.h>

#include <algorithm>
#include <limits>
#include <tuple>

namespace cadrefine
{
namespace
{

using Tolerances = ClassificationTolerances;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// What a mesh vertex asks for.
struct Candidate
{
  std::int32_t vertex = -1; ///< CAD vertex.
  double rank = infinity;   ///< 0: two of its CAD edges end there, close by; 1: otherwise.
  double distance = infinity;

  friend bool operator<(const Candidate& a, const Candidate& b)
  {
    return std::tie(a.rank, a.distance, a.vertex) < std::tie(b.rank, b.distance, b.vertex);
  }
};

class CornerAssignment
{
public:
  CornerAssignment(const ProjectionTask& task, const VertexClassification& meeting,
    const std::vector<unsigned char>& onCAD, std::vector<ClosestPoint>& hits)
    : task_(task), nurbs_(task.model().nurbs()), meeting_(meeting), hits_(hits),
      takesPart_(hits.size()), taken_(hits.size(), 0)
  {
    findApexes();
    for (std::size_t v = 0; v < hits.size(); ++v)
    {
      takesPart_[v] = onCAD[v] && hits[v].entity;
    }
  }

  std::vector<unsigned char> run()
  {
    give();
    return std::move(taken_);
  }

private:
  /// Finds the corners of each face at which no crease ends: they are not found by way of mesh
  /// edges along creases.
  void findApexes()
  {
    apexes_.resize(nurbs_.faces.size());
    for (const std::int32_t corner : task_.projector.corners())
    {
      const auto& edges = nurbs_.vertices[corner].edges;
      if (std::none_of(edges.begin(), edges.end(),
            [&](std::int32_t edge) { return nurbs_.edges[edge].sharp; }))
      {
        for (const std::int32_t face : entitiesAround(nurbs_, { 0, corner }, 2))
        {
          apexes_[face].push_back(corner);
        }
      }
    }
  }

  std::vector<std::int32_t> endsOf(std::int32_t edge) const
  {
    const NurbsEdge& e = nurbs_.edges[edge];
    return e.firstVertex < 0 ? std::vector<std::int32_t>{}
           : e.firstVertex == e.lastVertex
             ? std::vector<std::int32_t>{ e.firstVertex }
             : std::vector<std::int32_t>{ e.firstVertex, e.lastVertex };
  }

  std::size_t edgesEndingAt(std::size_t v, std::int32_t vertex) const
  {
    const auto& edges = meeting_.edges[v];
    const auto& ofVertex = nurbs_.vertices[vertex].edges;
    return static_cast<std::size_t>(std::count_if(edges.begin(), edges.end(),
      [&](std::int32_t edge)
      { return std::binary_search(ofVertex.begin(), ofVertex.end(), edge); }));
  }

  Candidate candidateFor(std::size_t v, std::int32_t vertex, bool isApex) const
  {
    const NurbsVertex& wanted = nurbs_.vertices[vertex];
    const double away = distance(task_.points()[v], wanted.point);
    const double longest = task_.boundary.longestEdge[v];
    const bool close = away <= Tolerances::jointDistance * task_.boundary.shortestEdge[v];
    const bool joins = edgesEndingAt(v, vertex) >= std::min<std::size_t>(2, wanted.edges.size());
    const double rank = joins && close && !isApex ? 0 : 1;
    if (task_.projector.isCorner(vertex))
    {
      return away <= std::min(task_.limit(v), Tolerances::cornerDistance * longest)
               ? Candidate{ vertex, rank, away }
               : Candidate{};
    }
    const bool mayMove = !meeting_.settled[v] || away <= task_.exact(v) + wanted.tolerance;
    return joins && close && mayMove && away <= task_.limit(v) ? Candidate{ vertex, rank, away }
                                                               : Candidate{};
  }

  Candidate bestCandidate(std::size_t v) const
  {
    Candidate best;
    for (const std::int32_t edge : meeting_.edges[v])
    {
      for (const std::int32_t vertex : endsOf(edge))
      {
        best = std::min(best, candidateFor(v, vertex, false));
      }
    }
    for (const std::int32_t face : meeting_.faces[v])
    {
      for (const std::int32_t apex : apexes_[face])
      {
        best = std::min(best, candidateFor(v, apex, true));
      }
    }
    return best;
  }

  void give()
  {
    const auto& ids = task_.mesh.mesh().ids;
    for (std::size_t v = 0; v < hits_.size(); ++v)
    {
      candidates_.push_back(takesPart_[v] ? bestCandidate(v) : Candidate{});
    }
    const auto ranks = least(
      infinity, [&](std::size_t v) { return candidates_[v].rank; },
      [](std::size_t) { return true; });
    const auto ofRank = [&](std::size_t v)
    { return candidates_[v].rank == ranks[candidates_[v].vertex]; };
    const auto distances = least(
      infinity, [&](std::size_t v) { return candidates_[v].distance; }, ofRank);
    const auto nearest = [&](std::size_t v)
    { return ofRank(v) && candidates_[v].distance == distances[candidates_[v].vertex]; };
    const auto takers = least(
      std::numeric_limits<std::int64_t>::max(),
      [&](std::size_t v) { return std::int64_t{ ids[v] }; }, nearest);
    for (std::size_t v = 0; v < hits_.size(); ++v)
    {
      if (candidates_[v].vertex >= 0 && takers[candidates_[v].vertex] == ids[v])
      {
        hits_[v] = task_.projector.nearestOn({ 0, candidates_[v].vertex }, task_.points()[v]);
        taken_[v] = 1;
      }
    }
  }

  /// For each CAD vertex the least value of the vertices of all ranks that ask for it and are
  /// `considered`.
  template<class Value, class Of, class Considered>
  std::vector<Value> least(Value initial, const Of& valueOf, const Considered& considered) const
  {
    std::vector<Value> result(nurbs_.vertices.size(), initial);
    for (std::size_t v = 0; v < candidates_.size(); ++v)
    {
      const std::int32_t vertex = candidates_[v].vertex;
      if (vertex >= 0 && considered(v))
      {
        result[vertex] = std::min(result[vertex], valueOf(v));
      }
    }
    return task_.exchange.min(result);
  }

  const ProjectionTask& task_;
  const NurbsModel& nurbs_;
  const VertexClassification& meeting_;
  std::vector<ClosestPoint>& hits_;
  std::vector<unsigned char> takesPart_;
  std::vector<unsigned char> taken_;
  std::vector<Candidate> candidates_;
  std::vector<std::vector<std::int32_t>> apexes_; ///< The apexes of each face.
};

} // namespace

std::vector<unsigned char> giveCorners(const ProjectionTask& task,
  const VertexClassification& meeting, const std::vector<unsigned char>& onCAD,
  std::vector<ClosestPoint>& hits)
{
  return CornerAssignment(task, meeting, onCAD, hits).run();
}

} // namespace cadrefine
