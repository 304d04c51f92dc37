#include "InitialProjection.h"

#include "Agreement.h"
#include "DistributedMoves.h"
#include "EvenWork.h"

#include <algorithm>
#include <limits>

namespace cadrefine
{
namespace
{

bool inRegion(const ProjectionOptions& options, const Point3& p)
{
  if (!options.region)
  {
    return true;
  }
  const auto& r = *options.region;
  return p[0] >= r[0] && p[0] <= r[1] && p[1] >= r[2] && p[1] <= r[3] && p[2] >= r[4] &&
         p[2] <= r[5];
}

/// A point that looks for its nearest one on the CAD, up to a limit.
struct PointQuestion
{
  Point3 point;
  double limit;
};

/// The steps of projectBoundary.
class InitialProjector
{
public:
  InitialProjector(RankExchange& exchange, DistributedMesh& mesh,
    const BoundaryProjector& projector, const DistributedBoundary& boundary,
    const ProjectionOptions& options)
    : exchange_(exchange), mesh_(mesh), projector_(projector), boundary_(boundary),
      options_(options), hits_(mesh.mesh().points.size()), onCAD_(hits_.size(), 0),
      onCrease_(hits_.size(), 0)
  {
  }

  ProjectionResult run()
  {
    findNearest();
    classifyFacets();
    attempt(exchange_, [&] { snapToCreases(); });
    giveCorners();
    return move();
  }

private:
  double limit(std::size_t vertex) const
  {
    return options_.maximumDistance > 0 ? options_.maximumDistance : boundary_.longestEdge[vertex];
  }

  void findNearest()
  {
    const auto& points = mesh_.mesh().points;
    const auto owned = mesh_.shared.ownedHere(static_cast<Index>(points.size()));
    std::vector<Index> vertices;
    std::vector<PointQuestion> questions;
    for (std::size_t v = 0; v < points.size(); ++v)
    {
      if (boundary_.onBoundary[v] && inRegion(options_, points[v]))
      {
        vertices.push_back(static_cast<Index>(v));
        questions.push_back({ points[v], limit(v) });
        projected_ += owned[v];
      }
    }
    const auto answers = answerEvenly<ClosestPoint>(exchange_, std::move(questions),
      [&](const PointQuestion& question)
      { return projector_.nearest(question.point, question.limit); });
    for (std::size_t i = 0; i < vertices.size(); ++i)
    {
      hits_[vertices[i]] = answers.values[i];
    }
    balance_ = answers.balance;
  }

  std::vector<FacetRecord> makeRecords() const
  {
    std::vector<EntityId> entities(hits_.size());
    std::transform(hits_.begin(), hits_.end(), entities.begin(),
      [](const ClosestPoint& hit) { return hit.entity; });
    std::vector<FacetRecord> records;
    for (const Facet& facet : boundary_.facets)
    {
      records.push_back(
        makeRecord(projector_, classifiedFacet(mesh_.mesh(), entities, facet, boundary_.kind)));
      records.back().onCAD = records.back().onCAD && keepsItsShape(facet);
      const auto end = facet.vertices.begin() + boundary_.facetCorners();
      records.back().free = std::any_of(facet.vertices.begin(), end,
        [&](Index vertex) { return !inRegion(options_, mesh_.mesh().points[vertex]); });
    }
    return records;
  }

  /// Whether the facet looks alike on the CAD: no edge shorter than half of it or longer than
  /// twice, no corner farther away than half of the longest edge. Facets of walls and of the far
  /// field collapse when their corners are projected.
  bool keepsItsShape(const Facet& facet) const
  {
    const auto& points = mesh_.mesh().points;
    const int corners = boundary_.facetCorners();
    double longest = 0;
    double farthest = 0;
    for (int k = 0; k < corners; ++k)
    {
      const Index a = facet.vertices[k];
      const Index b = facet.vertices[(k + 1) % corners];
      const double before = distance(points[a], points[b]);
      const double after = distance(hits_[a].point, hits_[b].point);
      if (after < 0.5 * before || after > 2 * before)
      {
        return false;
      }
      longest = std::max(longest, before);
      farthest = std::max(farthest, hits_[a].distance);
    }
    return farthest <= 0.5 * longest;
  }

  void classifyFacets()
  {
    std::vector<FacetRecord> records;
    attempt(exchange_, [&] { records = makeRecords(); });
    for (std::size_t f = 0; f < records.size(); ++f)
    {
      for (int k = 0; records[f].onCAD && k < boundary_.facetCorners(); ++k)
      {
        onCAD_[boundary_.facets[f].vertices[k]] = 1;
      }
    }
    const auto ofEdges = gatherFacetRecords(exchange_, boundary_, records);
    attempt(exchange_, [&] { findCreaseVertices(ofEdges); });
    const auto either = [](unsigned char a, unsigned char b) { return std::max(a, b); };
    combineShared(exchange_, mesh_.shared, onCAD_, either);
    combineShared(exchange_, mesh_.shared, onCrease_, either);
  }

  void findCreaseVertices(const std::vector<std::vector<FacetRecord>>& ofEdges)
  {
    const auto& points = mesh_.mesh().points;
    const auto& edges = boundary_.edges.edges();
    for (std::size_t e = 0; e < edges.size(); ++e)
    {
      const auto [a, b] = edges[e];
      if (hits_[a].entity && hits_[b].entity &&
          projector_.runsAlongCrease(points[a], points[b], ofEdges[e]))
      {
        onCrease_[a] = 1;
        onCrease_[b] = 1;
      }
    }
  }

  void snapToCreases()
  {
    const auto& points = mesh_.mesh().points;
    for (std::size_t v = 0; v < points.size(); ++v)
    {
      if (onCrease_[v] && boundary_.kind == BoundaryKind::Triangles)
      {
        const ClosestPoint hit = projector_.nearestCrease(points[v], limit(v));
        hits_[v] = hit.entity ? hit : hits_[v];
      }
    }
  }

  /// The corner nearest to a vertex that may take one, as (place in corners(), distance).
  std::pair<std::size_t, double> nearestCorner(std::size_t vertex) const
  {
    const auto& corners = projector_.corners();
    std::pair<std::size_t, double> best{ 0, std::numeric_limits<double>::infinity() };
    for (std::size_t c = 0; c < corners.size(); ++c)
    {
      const double away = distance(
        mesh_.mesh().points[vertex], projector_.model().nurbs().vertices[corners[c]].point);
      best = away < best.second ? std::make_pair(c, away) : best;
    }
    const double reach = std::min(limit(vertex), 0.5 * boundary_.longestEdge[vertex]);
    return best.second <= reach
             ? best
             : std::make_pair(best.first, std::numeric_limits<double>::infinity());
  }

  /// One to one: each corner to the nearest vertex, on a tie to the one with the smallest id.
  void giveCorners()
  {
    const auto& corners = projector_.corners();
    const auto& ids = mesh_.mesh().ids;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::vector<std::pair<std::size_t, double>> wishes(hits_.size(), { 0, infinity });
    std::vector<double> nearest(corners.size(), infinity);
    for (std::size_t v = 0; v < hits_.size() && !corners.empty(); ++v)
    {
      if (onCrease_[v] && onCAD_[v])
      {
        wishes[v] = nearestCorner(v);
        nearest[wishes[v].first] = std::min(nearest[wishes[v].first], wishes[v].second);
      }
    }
    nearest = exchange_.min(nearest);
    std::vector<std::int64_t> takers(corners.size(), std::numeric_limits<std::int64_t>::max());
    for (std::size_t v = 0; v < hits_.size(); ++v)
    {
      const auto [corner, away] = wishes[v];
      if (away < infinity && away == nearest[corner])
      {
        takers[corner] = std::min(takers[corner], ids[v]);
      }
    }
    takers = exchange_.min(takers);
    for (std::size_t v = 0; v < hits_.size(); ++v)
    {
      if (wishes[v].second < infinity && takers[wishes[v].first] == ids[v])
      {
        hits_[v] = projector_.nearestOn({ 0, corners[wishes[v].first] }, mesh_.mesh().points[v]);
      }
    }
  }

  ProjectionResult move()
  {
    ProjectionResult result;
    result.classification.resize(hits_.size());
    Moves moves(mesh_.mesh());
    for (std::size_t v = 0; v < hits_.size(); ++v)
    {
      if (onCAD_[v] && hits_[v].entity)
      {
        result.classification.set(static_cast<Index>(v), hits_[v]);
        moves.add(static_cast<Index>(v), hits_[v].point);
      }
    }
    result.classification.distances = moveVertices(exchange_, mesh_, moves, boundary_.onBoundary);
    result.projectedPoints = exchange_.sum(projected_);
    result.balance = balance_;
    return result;
  }

  RankExchange& exchange_;
  DistributedMesh& mesh_;
  const BoundaryProjector& projector_;
  const DistributedBoundary& boundary_;
  const ProjectionOptions& options_;
  std::vector<ClosestPoint> hits_;      ///< Of each vertex.
  std::vector<unsigned char> onCAD_;    ///< A facet on the CAD has it.
  std::vector<unsigned char> onCrease_; ///< It is to lie on a crease.
  std::int64_t projected_ = 0;
  WorkBalance balance_;
};

} // namespace

ProjectionResult projectBoundary(RankExchange& exchange, DistributedMesh& mesh,
  const BoundaryProjector& projector, const DistributedBoundary& boundary,
  const ProjectionOptions& options)
{
  return InitialProjector(exchange, mesh, projector, boundary, options).run();
}

ProjectionResult projectPoints(RankExchange& exchange, DistributedMesh& mesh, const CADModel& model,
  const ProjectionOptions& options)
{
  auto& points = mesh.mesh().points;
  ProjectionResult result;
  result.classification.resize(points.size());
  const auto owned = mesh.shared.ownedHere(static_cast<Index>(points.size()));
  SearchScope scope;
  if (options.maximumDistance > 0)
  {
    scope.maximumDistance = options.maximumDistance;
  }
  std::vector<Index> vertices;
  std::vector<Point3> questions;
  for (std::size_t v = 0; v < points.size(); ++v)
  {
    if (inRegion(options, points[v]))
    {
      vertices.push_back(static_cast<Index>(v));
      questions.push_back(points[v]);
      result.projectedPoints += owned[v];
    }
  }
  const auto answers = answerEvenly<ClosestPoint>(exchange, std::move(questions),
    [&](const Point3& point) { return model.nearest(point, scope); });
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    const ClosestPoint& hit = answers.values[i];
    if (hit.entity)
    {
      result.classification.set(vertices[i], hit);
      points[vertices[i]] = hit.point;
    }
  }
  result.projectedPoints = exchange.sum(result.projectedPoints);
  result.balance = answers.balance;
  return result;
}

} // namespace cadrefine
