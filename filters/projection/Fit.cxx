#include "projection/Fit.h"

#include "comm/LoadBalancedMap.h"

#include <cadrefine/classification/ClassificationTolerances.h>
#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace cadrefine
{
namespace
{

constexpr double boxMargin = 1e-6; ///< Part of the CAD's size: its box is no more exact.
constexpr double onCAD = 1e-7;     ///< Part of the CAD's size: nearer vertices lie on it.
/// In parts of its longest edge, a vertex among others on the CAD is farther from it only if it
/// belongs elsewhere, or is part of a coarse cut.
constexpr double strayPart = 0.05;
constexpr std::size_t mostListed = 10;
constexpr std::size_t mostConflicts = 100;

/// A vertex, or a facet, in a list that all ranks make together.
struct Entry
{
  double size = 0; ///< Distance of a vertex, measure of a facet.
  double id = 0;   ///< Of a vertex.
  Point3 point{};

  bool operator<(const Entry& other) const
  {
    return std::tie(other.size, id, point) < std::tie(size, other.id, other.point);
  }
};

/// The first `most` entries of all ranks. Collective; 5 x `most` numbers are gathered from each
/// rank.
std::vector<Entry> firstOf(RankExchange& exchange, std::vector<Entry> mine, std::size_t most)
{
  constexpr double none = -1;
  std::sort(mine.begin(), mine.end());
  mine.resize(most, { none, 0, {} });
  std::vector<double> numbers;
  for (const Entry& entry : mine)
  {
    const auto& [x, y, z] = entry.point;
    numbers.insert(numbers.end(), { entry.size, entry.id, x, y, z });
  }
  numbers = exchange.gather(numbers);
  std::vector<Entry> all;
  for (std::size_t i = 0; i < numbers.size(); i += 5)
  {
    if (numbers[i] != none)
    {
      all.push_back(
        { numbers[i], numbers[i + 1], { numbers[i + 2], numbers[i + 3], numbers[i + 4] } });
    }
  }
  std::sort(all.begin(), all.end());
  all.resize(std::min(all.size(), most));
  return all;
}

double measureOf(const Mesh& mesh, const Facet& facet)
{
  const auto p = pointsOf(mesh, facet);
  return facet.corners() == 2 ? distance(p[0], p[1])
                              : 0.5 * norm(twofoldAreaVector(p, facet.corners()));
}

/// Whether the direction of a face's normal, or of an edge, changes over it.
bool isCurved(const CADModel& model, EntityId entity)
{
  constexpr double alike = 1e-6;
  constexpr std::array<double, 3> places{ 0.2, 0.5, 0.8 };
  std::optional<Vector3> first;
  const auto turns = [&](const Vector3& direction)
  {
    first = first.value_or(direction);
    return norm(cross(*first, direction)) > alike;
  };
  if (entity.dimension == 2)
  {
    for (const BezierPatch& patch : model.nurbs().faces[entity.index].patches)
    {
      for (const double u : places)
      {
        for (const double v : places)
        {
          if (turns(model.normal(entity.index,
                { patch.u0 + u * (patch.u1 - patch.u0), patch.v0 + v * (patch.v1 - patch.v0) })))
          {
            return true;
          }
        }
      }
    }
  }
  else if (entity.dimension == 1)
  {
    for (const BezierCurve& segment : model.nurbs().edges[entity.index].segments)
    {
      for (const double t : places)
      {
        if (turns(model.tangent(entity.index, segment.t0 + t * (segment.t1 - segment.t0))))
        {
          return true;
        }
      }
    }
  }
  return false;
}

class FitSearch
{
public:
  FitSearch(const ProjectionTask& task, const ProjectionResult& result, Fit& fit)
    : task_(task), result_(result), fit_(fit), dimension_(dimensionOf(task.boundary.kind)),
      entities_(task.model().count(dimension_))
  {
  }

  void measureBoundary()
  {
    std::vector<double> all;
    std::vector<double> inBox;
    std::vector<double> onCADToo;
    std::vector<Entry> bridges;
    // Parts of the entities' own measures in units of 2^-40, which sum up the same on any ranks.
    std::vector<std::int64_t> parts(entities_, 0);
    entityOfFacet_.assign(task_.boundary.facets.size(), -1);
    const auto& facets = task_.boundary.facets;
    for (std::size_t f = 0; f < facets.size(); ++f)
    {
      const FacetRecord& record = result_.facets[f];
      const double measure = measureOf(task_.mesh.mesh(), facets[f]);
      if (record.onCAD)
      {
        onCADToo.push_back(measure);
        entityOfFacet_[f] = task_.ofFaces() ? record.face : edgeOf(facets[f]);
        addPart(parts, entityOfFacet_[f], measure);
      }
      // Listed ones inside the mesh need not be of the CAD.
      const bool isAsked = !record.free && !facets[f].isInside;
      const Point3 middle = centroidOf(task_.mesh.mesh(), facets[f]);
      const bool isOffInBox = !record.onCAD && isAsked && isInBox(middle);
      if (record.onCAD || isOffInBox)
      {
        inBox.push_back(measure);
      }
      if (isOffInBox && isBetweenVerticesOnCAD(facets[f]))
      {
        bridges.push_back({ measure, 0, middle });
      }
      if (record.onCAD || isAsked)
      {
        all.push_back(measure);
      }
    }
    const double total = task_.exchange.sumReproducibly(all);
    const double counted = task_.exchange.sumReproducibly(inBox);
    const double covering = task_.exchange.sumReproducibly(onCADToo);
    fit_.boundaryOnCAD = counted > 0 ? covering / counted : 0;
    fit_.boundaryInBox = total > 0 ? counted / total : 0;
    fit_.cadCovered = coveredShare(task_.exchange.sum(parts));
    fit_.bridgingFacets = task_.exchange.sum(bridges.size());
    for (const Entry& entry : firstOf(task_.exchange, std::move(bridges), mostListed))
    {
      fit_.bridges.push_back(entry.point);
    }
  }

  void countVerticesOnCurved()
  {
    const auto& entities = result_.classification.entities;
    const auto owned = task_.mesh.shared.ownedHere(static_cast<Index>(entities.size()));
    std::map<EntityId, bool> curved;
    std::int64_t all = 0;
    std::int64_t before = 0;
    for (std::size_t v = 0; v < entities.size(); ++v)
    {
      if (!owned[v] || !entities[v])
      {
        continue;
      }
      const auto [place, isNew] = curved.try_emplace(entities[v], false);
      if (isNew)
      {
        place->second = isCurved(task_.model(), entities[v]);
      }
      all += place->second;
      before += place->second && wasOnCAD(v);
    }
    all = task_.exchange.sum(all);
    before = task_.exchange.sum(before);
    fit_.wasOnCurved = all > 0 ? static_cast<double>(before) / static_cast<double>(all) : 0;
  }

  void findStrays()
  {
    const Mesh& mesh = task_.mesh.mesh();
    const auto isStray = flagStrays();
    const auto owned = task_.mesh.shared.ownedHere(static_cast<Index>(isStray.size()));
    std::vector<Entry> strays;
    for (std::size_t v = 0; v < isStray.size(); ++v)
    {
      if (owned[v] && isStray[v])
      {
        strays.push_back(
          { result_.distancesBefore[v], static_cast<double>(mesh.ids[v]), mesh.points[v] });
      }
    }
    fit_.strays = task_.exchange.sum(strays.size());
    for (const Entry& entry : firstOf(task_.exchange, std::move(strays), 1))
    {
      fit_.farthestStray = { entry.point, entry.size };
    }
  }

private:
  bool wasOnCAD(std::size_t vertex) const
  {
    return result_.distancesBefore[vertex] <= task_.rounded(vertex);
  }

  bool isBetweenVerticesOnCAD(const Facet& facet) const
  {
    const auto& entities = result_.classification.entities;
    return std::all_of(facet.begin(), facet.end(),
      [&](Index vertex) { return static_cast<bool>(entities[vertex]); });
  }

  bool isInBox(const Point3& p) const
  {
    return fit_.cadBox.contains(p, boxMargin * task_.model().size());
  }

  /// 1 for vertices that are counted in Fit::strays, on whatever rank. Collective.
  std::vector<unsigned char> flagStrays() const
  {
    const auto& facets = task_.boundary.facets;
    std::vector<std::int64_t> exact(entities_, 0); // facets
    std::vector<std::int64_t> all(entities_, 0);
    for (std::size_t f = 0; f < facets.size(); ++f)
    {
      if (entityOfFacet_[f] >= 0)
      {
        exact[entityOfFacet_[f]] += std::all_of(
          facets[f].begin(), facets[f].end(), [&](Index vertex) { return wasOnCAD(vertex); });
        ++all[entityOfFacet_[f]];
      }
    }
    exact = task_.exchange.sum(exact);
    all = task_.exchange.sum(all);
    const auto isMostlyExact = [&](std::int32_t entity)
    {
      return entity >= 0 &&
             static_cast<double>(exact[entity]) >=
               ClassificationTolerances::sideMajority * static_cast<double>(all[entity]);
    };
    std::vector<unsigned char> isStray(task_.points().size(), 0);
    for (std::size_t f = 0; f < facets.size(); ++f)
    {
      for (const Index vertex : facets[f])
      {
        const bool isOff =
          result_.distancesBefore[vertex] > strayPart * task_.boundary.longestEdge[vertex];
        isStray[vertex] = isStray[vertex] || (isOff && isMostlyExact(entityOfFacet_[f]));
      }
    }
    combineFlags(task_.exchange, task_.mesh.shared, isStray);
    return isStray;
  }

  /// The CAD edge of a segment on the CAD.
  std::int32_t edgeOf(const Facet& segment) const
  {
    for (int end = 0; end < 2; ++end)
    {
      const EntityId entity = result_.classification.entities[segment.vertices[end]];
      if (entity.dimension == 1)
      {
        return entity.index;
      }
    }
    const ClosestPoint middle = task_.projector.nearest(
      centroidOf(task_.mesh.mesh(), segment), std::numeric_limits<double>::infinity());
    return middle.entity.dimension == 1 ? middle.entity.index : -1;
  }

  void addPart(std::vector<std::int64_t>& parts, std::int32_t index, double measure) const
  {
    const double whole = index < 0 ? 0 : task_.model().measure({ dimension_, index });
    if (whole > 0)
    {
      constexpr double most = 1024; // more would be no better, and could overflow in a sum
      parts[index] += std::llround(std::ldexp(std::min(measure / whole, most), 40));
    }
  }

  double coveredShare(const std::vector<std::int64_t>& parts) const
  {
    double covered = 0;
    double all = 0;
    for (std::size_t i = 0; i < parts.size(); ++i)
    {
      const double whole = task_.model().measure({ dimension_, static_cast<std::int32_t>(i) });
      covered += whole * std::min(1.0, std::ldexp(static_cast<double>(parts[i]), -40));
      all += whole;
    }
    return all > 0 ? covered / all : 0;
  }

  const ProjectionTask& task_;
  const ProjectionResult& result_;
  Fit& fit_;
  std::int8_t dimension_;
  std::size_t entities_;
  /// The CAD face of each facet (in the plane, its edge); -1: none.
  std::vector<std::int32_t> entityOfFacet_;
};

/// Finds the vertices in conflict. Collective.
void findConflicts(
  RankExchange& exchange, const DistributedMesh& mesh, const ProjectionResult& result, Fit& fit)
{
  const auto owned = mesh.shared.ownedHere(static_cast<Index>(result.conflicts.size()));
  std::vector<Entry> mine;
  for (std::size_t v = 0; v < result.conflicts.size(); ++v)
  {
    if (owned[v] && result.conflicts[v])
    {
      mine.push_back({ 0, static_cast<double>(mesh.mesh().ids[v]), mesh.mesh().points[v] });
    }
  }
  fit.conflictCount = exchange.sum(mine.size());
  if (fit.conflictCount > 0)
  {
    for (const Entry& entry : firstOf(exchange, std::move(mine), mostConflicts))
    {
      fit.conflicts.push_back(entry.point);
    }
  }
}

} // namespace

Fit findFit(const ProjectionTask& task, const ProjectionResult& result)
{
  Fit fit;
  fit.cadBox = task.model().box();
  FitSearch search(task, result, fit);
  search.measureBoundary();
  search.countVerticesOnCurved();
  search.findStrays();
  findConflicts(task.exchange, task.mesh, result, fit);
  return fit;
}

void findVerticesOff(RankExchange& exchange, const DistributedMesh& mesh,
  const BoundaryProjector& projector, const std::vector<unsigned char>& onBoundary,
  const Classification& classification, const ProjectionOptions& options, Fit& fit)
{
  const std::vector<Point3>& points = mesh.mesh().points;
  const double size = projector.model().size();
  const auto owned = mesh.shared.ownedHere(static_cast<Index>(points.size()));
  std::vector<Entry> off;
  const auto addIfOff = [&](std::size_t v, double distance)
  {
    if (distance > onCAD * size)
    {
      off.push_back({ distance, static_cast<double>(mesh.mesh().ids[v]), points[v] });
    }
  };
  NumberedQueries<Point3> asked;
  for (std::size_t v = 0; v < points.size(); ++v)
  {
    if (!owned[v] || !onBoundary[v] || !options.inRegion(points[v]))
    {
      continue;
    }
    if (classification.entities[v])
    {
      addIfOff(v, classification.distances[v]);
    }
    else if (fit.cadBox.contains(points[v], boxMargin * size))
    {
      asked.add(v, points[v]);
    }
  }
  answerBalanced<double>(exchange, std::move(asked),
    [&](const Point3& point)
    { return projector.nearest(point, std::numeric_limits<double>::infinity()).distance; },
    addIfOff, { "measuring the fit at", "vertices" });
  fit.verticesOffCAD = exchange.sum(off.size());
  for (const Entry& entry : firstOf(exchange, std::move(off), mostListed))
  {
    fit.farthest.push_back({ entry.point, entry.size });
  }
}

Fit findFitOfPoints(RankExchange& exchange, const DistributedMesh& mesh, const CADModel& model,
  const ProjectionResult& result)
{
  Fit fit;
  fit.cadBox = model.box();
  const auto& entities = result.classification.entities;
  const auto owned = mesh.shared.ownedHere(static_cast<Index>(entities.size()));
  std::int64_t reached = 0;
  for (std::size_t v = 0; v < entities.size(); ++v)
  {
    reached += owned[v] && entities[v];
  }
  reached = exchange.sum(reached);
  fit.verticesOffCAD = result.projectedPoints - reached;
  fit.boundaryInBox = 1;
  fit.boundaryOnCAD = result.projectedPoints > 0
                        ? static_cast<double>(reached) / static_cast<double>(result.projectedPoints)
                        : 0;
  return fit;
}

} // namespace cadrefine
