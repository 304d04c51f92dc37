#include <cadrefine/motion/PatchOptimiser.h>

#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/base/MixedBits.h>
#include <cadrefine/base/SortUniquely.h>
#include <cadrefine/classification/ClassificationTolerances.h>
#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace cadrefine
{
namespace
{

/// Shortest and longest step that is tried, as parts of Newton's step.
constexpr double shortestStep = 1.0 / 32;
constexpr double longestStep = 8;
/// The chord of half of an arc is so far from it, in terms of the distance of the whole one's.
constexpr double ofHalfAnArc = 0.25;
/// Exponent of ShapeEnergy where the worst cell counts most.
constexpr int exponentForWorst = 16;

std::uint64_t hashOf(GlobalId id)
{
  return mixedBits(static_cast<std::uint64_t>(id));
}

template<std::size_t Corners>
double squaredLengths(const std::array<Index, Corners>& cell, const std::vector<Point3>& points)
{
  double sum = 0;
  for (std::size_t i = 0; i < Corners; ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      sum += squaredNorm(points[cell[i]] - points[cell[j]]);
    }
  }
  return sum;
}

/// The ids of a cell, ascending: an order of cells that is the same on every rank.
template<std::size_t Corners>
std::array<GlobalId, Corners> sortedIds(
  const std::array<Index, Corners>& cell, const std::vector<GlobalId>& ids)
{
  std::array<GlobalId, Corners> result;
  std::transform(cell.begin(), cell.end(), result.begin(), [&](Index v) { return ids[v]; });
  std::sort(result.begin(), result.end());
  return result;
}

} // namespace

Directions directionsOn(const BoundaryProjector& projector, EntityId entity, const Point3& point)
{
  const ClosestPoint where = projector.nearestOn(entity, point);
  if (where.entity != entity || entity.dimension == 0)
  {
    return {};
  }
  const CADModel& model = projector.model();
  return entity.dimension == 2
           ? Directions::across(model.normal(entity.index, where.parameters))
           : Directions::along(model.tangent(entity.index, where.parameters[0]));
}

PatchOptimiser::PatchOptimiser(
  Patch& patch, const BoundaryProjector* projector, ParallelFor parallelFor)
  : patch_(patch), projector_(projector), parallelFor_(std::move(parallelFor)),
    firstOfStar_(patch.mesh.points.size() + 1, 0), turns_(patch.mesh.points.size()),
    done_(patch.mesh.points.size(), 0)
{
  visitOwnSimplices(patch.mesh, [&](const auto& cells) { prepare(cells); });
  for (std::size_t v = 0; v < turns_.size(); ++v)
  {
    turns_[v] = hashOf(patch.mesh.ids[v]);
  }
  order_ = indicesWhere(patch.free.size(), [&](std::size_t v) { return patch.free[v] != 0; });
  std::sort(order_.begin(), order_.end(), [&](Index a, Index b) { return turns_[a] > turns_[b]; });
  findLevels();
  findBoundaries();
}

/// Calls visit(corner) for the corners of all cells at the vertex, itself and repetitions included.
template<class Visit>
void PatchOptimiser::forCornersRound(Index vertex, const Visit& visit) const
{
  for (std::size_t s = firstOfStar_[vertex]; s < firstOfStar_[vertex + 1]; ++s)
  {
    visitOwnSimplices(patch_.mesh, [&, cell = stars_[s]](const auto& cells)
      { std::for_each(cells[cell].begin(), cells[cell].end(), visit); });
  }
}

/// Orders the free vertices by levels: a vertex is one level above the highest free neighbour that
/// comes before it, so that vertices of one level are no neighbours.
void PatchOptimiser::findLevels()
{
  std::vector<std::size_t> level(turns_.size(), 0);
  for (const Index vertex : order_)
  {
    forCornersRound(vertex,
      [&](Index other)
      {
        if (comesBefore(other, vertex))
        {
          level[vertex] = std::max(level[vertex], level[other] + 1);
        }
      });
  }
  std::stable_sort(
    order_.begin(), order_.end(), [&](Index a, Index b) { return level[a] < level[b]; });
  levels_ = { 0 };
  for (std::size_t i = 1; i <= order_.size(); ++i)
  {
    if (i == order_.size() || level[order_[i]] != level[order_[i - 1]])
    {
      levels_.push_back(i);
    }
  }
}

template<std::size_t Corners>
void PatchOptimiser::prepare(const Cells<Corners>& cells)
{
  std::vector<Index> sorted(cells.size());
  std::vector<std::array<GlobalId, Corners>> keys;
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    sorted[c] = static_cast<Index>(c);
    keys.push_back(sortedIds(cells[c], patch_.mesh.ids));
    const double size = keepsShape(c) ? measure(cells[c], patch_.start) : 0;
    sizes_.push_back(size > 0 ? size
                              : equilateralMeasure(static_cast<int>(Corners) - 1,
                                  squaredLengths(cells[c], patch_.start)));
    for (const Index vertex : cells[c])
    {
      ++firstOfStar_[vertex + 1];
    }
  }
  std::sort(sorted.begin(), sorted.end(), [&](Index a, Index b) { return keys[a] < keys[b]; });
  for (std::size_t v = 1; v < firstOfStar_.size(); ++v)
  {
    firstOfStar_[v] += firstOfStar_[v - 1];
  }
  stars_.resize(firstOfStar_.back());
  std::vector<std::size_t> next = firstOfStar_;
  for (const Index c : sorted)
  {
    for (const Index vertex : cells[c])
    {
      stars_[next[vertex]++] = c;
    }
  }
}

Vector3 PatchOptimiser::normalAt(const std::array<Index, 3>& triangle) const
{
  const auto& p = patch_.start;
  return patch_.plane != Vector3{}
           ? patch_.plane
           : normalized(twofoldAreaVector(p[triangle[0]], p[triangle[1]], p[triangle[2]]));
}

double PatchOptimiser::measure(const std::array<Index, 4>& cell, const std::vector<Point3>& p) const
{
  return sixfoldVolume(p[cell[0]], p[cell[1]], p[cell[2]], p[cell[3]]);
}

double PatchOptimiser::measure(const std::array<Index, 3>& cell, const std::vector<Point3>& p) const
{
  return dot(normalAt(cell), twofoldAreaVector(p[cell[0]], p[cell[1]], p[cell[2]]));
}

double PatchOptimiser::smallestMeasure() const
{
  double smallest = 1;
  for (std::size_t c = 0; c < sizes_.size(); ++c)
  {
    const double size = visitOwnSimplices(
      patch_.mesh, [&](const auto& cells) { return measure(cells[c], patch_.mesh.points); });
    smallest = sizes_[c] > 0 ? std::min(smallest, size / sizes_[c]) : smallest;
  }
  return smallest;
}

void PatchOptimiser::beginSweep(double smallest)
{
  delta_ = regularisation(smallest);
  std::fill(done_.begin(), done_.end(), 0);
}

bool PatchOptimiser::advance()
{
  const auto takeTurn = [&](Index vertex)
  {
    if (!done_[vertex] && patch_.complete[vertex] && !mustWait(vertex))
    {
      improve(vertex);
      done_[vertex] = 1;
    }
  };
  for (std::size_t l = 1; l < levels_.size(); ++l)
  {
    const std::size_t first = levels_[l - 1];
    forEachIndex(parallelFor_, levels_[l] - first, coarseGrain,
      [&](std::size_t i) { takeTurn(order_[first + i]); });
  }
  return std::any_of(
    order_.begin(), order_.end(), [&](Index vertex) { return done_[vertex] == 0; });
}

void PatchOptimiser::place(Index vertex, const Point3& point)
{
  patch_.mesh.points[vertex] = point;
  done_[vertex] = 1;
}

bool PatchOptimiser::comesBefore(Index other, Index vertex) const
{
  return patch_.free[other] && turns_[other] > turns_[vertex];
}

bool PatchOptimiser::mustWait(Index vertex) const
{
  bool waits = false;
  forCornersRound(
    vertex, [&](Index other) { waits = waits || (comesBefore(other, vertex) && !done_[other]); });
  return waits;
}

ShapeEnergy PatchOptimiser::energyAt(Index vertex) const
{
  const Mesh& mesh = patch_.mesh;
  const auto& p = mesh.points;
  const auto& reference = patch_.start;
  ShapeEnergy energy(mesh.dimension);
  for (std::size_t s = firstOfStar_[vertex]; s < firstOfStar_[vertex + 1]; ++s)
  {
    const Index c = stars_[s];
    const double delta = delta_ * sizes_[c];
    if (mesh.dimension == 3)
    {
      const auto& cell = mesh.tetrahedra[c];
      const auto& face = faceOppositeTo(vertex, cell);
      // The faces' normals point away from the vertex.
      const auto& [i, k, j] = std::array{ cell[face[0]], cell[face[1]], cell[face[2]] };
      keepsShape(c) ? energy.addTetrahedron(p[i], p[j], p[k], delta,
                        { reference[i], reference[j], reference[k], reference[vertex] })
                    : energy.addTetrahedron(p[i], p[j], p[k], delta);
    }
    else
    {
      const auto& cell = mesh.triangles[c];
      const auto place = std::find(cell.begin(), cell.end(), vertex) - cell.begin();
      const Index i = cell[(place + 1) % 3];
      const Index j = cell[(place + 2) % 3];
      const Vector3 normal = normalAt(cell);
      keepsShape(c) ? energy.addTriangle(p[i], p[j], normal, delta,
                        { reference[i], reference[j], reference[vertex] })
                    : energy.addTriangle(p[i], p[j], normal, delta);
    }
  }
  return energy;
}

Point3 PatchOptimiser::onItsEntity(Index vertex, const Point3& point) const
{
  const EntityId entity = patch_.entities[vertex];
  if (!entity)
  {
    return point;
  }
  const ClosestPoint where = projector_->nearestOn(entity, point);
  return where.entity == entity ? where.point : patch_.mesh.points[vertex];
}

/// Finds the boundary's facets at a vertex all of whose cells are known: those that one cell has
/// alone. In the plane they have one other corner.
PatchOptimiser::Boundary PatchOptimiser::boundaryAt(Index vertex) const
{
  const auto& mesh = patch_.mesh;
  const bool areCells = isSurface(mesh, patch_.plane);
  std::vector<std::array<Index, 2>> others;
  const auto add = [&](Index a, Index b)
  {
    if (a != vertex && b != vertex)
    {
      others.push_back({ std::min(a, b), std::max(a, b) });
    }
  };
  for (std::size_t s = firstOfStar_[vertex]; s < firstOfStar_[vertex + 1]; ++s)
  {
    const Index c = stars_[s];
    if (mesh.dimension == 3)
    {
      const auto& cell = mesh.tetrahedra[c];
      for (const auto& [a, b] : tetrahedronEdges)
      {
        add(cell[a], cell[b]);
      }
    }
    else
    {
      const auto& cell = mesh.triangles[c];
      for (int k = 0; k < 3; ++k)
      {
        add(cell[k], cell[areCells ? (k + 1) % 3 : k]);
      }
    }
  }
  std::sort(others.begin(), others.end());
  Boundary boundary;
  for (auto pair = others.begin(); pair != others.end();)
  {
    const auto next = std::find_if(pair, others.end(), [&](const auto& o) { return o != *pair; });
    if (areCells || next - pair == 1)
    {
      boundary.facets.push_back(*pair);
      boundary.neighbours.insert(boundary.neighbours.end(), pair->begin(), pair->end());
    }
    pair = next;
  }
  sortUniquely(boundary.neighbours);
  return boundary;
}

/// Finds the boundary at free vertices on the CAD, and how far from the CAD it may lie.
void PatchOptimiser::findBoundaries()
{
  const auto sliding = indicesWhere(patch_.free.size(),
    [&](std::size_t v) { return patch_.free[v] && patch_.complete[v] && patch_.entities[v]; });
  if (sliding.empty())
  {
    return;
  }
  boundaries_.resize(patch_.free.size());
  std::vector<double> away(patch_.free.size(), 0);
  std::vector<unsigned char> isAsked(patch_.free.size(), 0);
  for (const Index vertex : sliding)
  {
    boundaries_[vertex] = boundaryAt(vertex);
    isAsked[vertex] = 1;
    for (const Index neighbour : boundaries_[vertex].neighbours)
    {
      isAsked[neighbour] = 1;
    }
  }
  const auto asked = indicesWhere(isAsked.size(), [&](std::size_t v) { return isAsked[v] != 0; });
  forEachIndex(parallelFor_, asked.size(), coarseGrain,
    [&](std::size_t i) { away[asked[i]] = distanceFromCAD(patch_.start[asked[i]]); });
  const double tie = ClassificationTolerances::tie * projector_->model().size();
  for (const Index vertex : sliding)
  {
    Boundary& boundary = boundaries_[vertex];
    boundary.limit = away[vertex];
    for (const Index neighbour : boundary.neighbours)
    {
      boundary.limit = std::max(boundary.limit, away[neighbour]);
    }
    boundary.limit = ofHalfAnArc * boundary.limit + tie;
  }
}

double PatchOptimiser::distanceFromCAD(const Point3& point) const
{
  return projector_->nearest(point, std::numeric_limits<double>::infinity()).distance;
}

/// The middles of the facets of the boundary at a vertex, and of their edges there, with the vertex
/// at `point`.
std::vector<Point3> PatchOptimiser::middlesRound(Index vertex, const Point3& point) const
{
  const auto& points = patch_.mesh.points;
  std::vector<Point3> middles;
  for (const Index other : boundaries_[vertex].neighbours)
  {
    middles.push_back(0.5 * (point + points[other]));
  }
  for (const auto& [a, b] : boundaries_[vertex].facets)
  {
    if (a != b)
    {
      middles.push_back((1.0 / 3) * (point + points[a] + points[b]));
    }
  }
  return middles;
}

/// Whether the facets round a vertex that moves to `next` stay as close to the CAD as they may, or
/// as they are now: `farthestNow` remembers how far that is, once it was needed.
bool PatchOptimiser::staysAsClose(
  Index vertex, const Point3& next, std::optional<double>& farthestNow) const
{
  const Point3& now = patch_.mesh.points[vertex];
  const auto longest = [&](const Point3& from)
  {
    double result = 0;
    for (const Index other : boundaries_[vertex].neighbours)
    {
      result = std::max(result, distance(from, patch_.mesh.points[other]));
    }
    return result;
  };
  if (longest(next) <= longest(now))
  {
    return true;
  }
  const auto middles = middlesRound(vertex, next);
  const auto areWithin = [&](double limit)
  {
    return std::all_of(middles.begin(), middles.end(),
      [&](const Point3& middle) { return projector_->isWithinDistance(middle, limit); });
  };
  const double limit = boundaries_[vertex].limit;
  if (!farthestNow)
  {
    if (areWithin(limit))
    {
      return true;
    }
    farthestNow = 0;
    for (const Point3& middle : middlesRound(vertex, now))
    {
      farthestNow = std::max(*farthestNow, distanceFromCAD(middle));
    }
  }
  return areWithin(std::max(limit, *farthestNow));
}

/// Moves a vertex by a step of Newton's method, halved until it gains something; where it does at
/// once, the step is doubled while it gains more: next to a singularity like s^-2, Newton's steps
/// are a third of the way.
void PatchOptimiser::improve(Index vertex)
{
  Point3& point = patch_.mesh.points[vertex];
  const EntityId entity = patch_.entities[vertex];
  ShapeEnergy energy = energyAt(vertex);
  if (patch_.fairQuality * energy.largestAt(point) <= 1)
  {
    energy.setExponent(exponentForWorst);
  }
  double lowest = energy.at(point);
  if (!std::isfinite(lowest))
  {
    return;
  }
  const Directions directions = entity ? directionsOn(*projector_, entity, point)
                                : patch_.mesh.dimension == 3 ? Directions::everywhere()
                                                             : Directions::across(patch_.plane);
  const Vector3 step = energy.step(point, directions);
  if (step == Vector3{})
  {
    return;
  }
  Point3 best = point;
  std::optional<double> farthestNow;
  const auto gains = [&](double length)
  {
    const Point3 next = onItsEntity(vertex, point + length * step);
    const double value = energy.at(next);
    if (!(value < lowest) || (entity && !staysAsClose(vertex, next, farthestNow)))
    {
      return false;
    }
    best = next;
    lowest = value;
    return true;
  };
  double length = 1;
  if (gains(length))
  {
    while (length < longestStep && gains(2 * length))
    {
      length *= 2;
    }
  }
  else
  {
    while (length > shortestStep && !gains(0.5 * length))
    {
      length *= 0.5;
    }
  }
  point = best;
}

} // namespace cadrefine
