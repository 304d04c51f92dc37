#include <cadrefine/operations/EditableMesh.h>

#include <cadrefine/mesh/Orientation.h>
#include <cadrefine/mesh/Quality.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace cadrefine
{
namespace
{

/// Label of segments that are not listed.
constexpr Index ownLabel = -1;
/// Label of segments between facets off the CAD.
constexpr Index creaseLabel = -2;

} // namespace

bool goesAlong(const std::array<Index, 3>& triangle, Index a, Index b)
{
  const auto place = std::find(triangle.begin(), triangle.end(), a) - triangle.begin();
  return place < 3 && triangle[(place + 1) % 3] == b;
}

void Cavity::clear()
{
  cells.clear();
  facets.clear();
  segments.clear();
  newCells.clear();
  newFacets.clear();
  newSegments.clear();
  sides.clear();
}

template<std::size_t Corners>
Index SimplexStore<Corners>::add(const Simplex& simplex)
{
  const auto number = static_cast<Index>(simplices_.size());
  simplices_.push_back(simplex);
  exists_.push_back(1);
  for (const Index vertex : simplex.corners)
  {
    at_[vertex].push_back(number);
  }
  return number;
}

template<std::size_t Corners>
void SimplexStore<Corners>::remove(Index simplex)
{
  exists_[simplex] = 0;
  for (const Index vertex : simplices_[simplex].corners)
  {
    std::vector<Index>& list = at_[vertex];
    list.erase(std::find(list.begin(), list.end(), simplex));
  }
}

template<std::size_t Corners>
void SimplexStore<Corners>::takeBack(std::size_t size, const std::vector<Index>& removed)
{
  for (std::size_t s = size; s < simplices_.size(); ++s)
  {
    if (exists_[s])
    {
      remove(static_cast<Index>(s));
    }
  }
  simplices_.erase(simplices_.begin() + static_cast<std::ptrdiff_t>(size), simplices_.end());
  exists_.resize(size);
  for (const Index simplex : removed)
  {
    exists_[simplex] = 1;
    for (const Index vertex : simplices_[simplex].corners)
    {
      std::vector<Index>& list = at_[vertex]; // ascending
      list.insert(std::lower_bound(list.begin(), list.end(), simplex), simplex);
    }
  }
}

template<std::size_t Corners>
std::vector<Index> SimplexStore<Corners>::at(Index a, Index b) const
{
  std::vector<Index> result;
  at(a, b, result);
  return result;
}

template<std::size_t Corners>
void SimplexStore<Corners>::at(Index a, Index b, std::vector<Index>& result) const
{
  result.clear();
  std::copy_if(at_[a].begin(), at_[a].end(), std::back_inserter(result),
    [&](Index simplex) { return hasCorner(simplices_[simplex].corners, b); });
}

template class SimplexStore<2>;
template class SimplexStore<3>;
template class SimplexStore<4>;

Index EditableMesh::addVertex(const Vertex& vertex)
{
  vertices_.push_back(vertex);
  cells_.addVertex();
  facets_.addVertex();
  segments_.addVertex();
  return static_cast<Index>(vertices_.size()) - 1;
}

void EditableMesh::closeFacets()
{
  for (std::size_t f = 0; f < facets_.size(); ++f)
  {
    const auto& corners = facets_[static_cast<Index>(f)].corners;
    for (int k = 0; k < 3; ++k)
    {
      const Index a = corners[k];
      const Index b = corners[(k + 1) % 3];
      const std::vector<Index> around = facets_.at(a, b);
      const bool areAlike = around.size() == 2 &&
                            facets_[around[0]].label == facets_[around[1]].label &&
                            (kind_ == Kind::Solid || goesAlong(facets_[around[0]].corners, a, b) !=
                                                       goesAlong(facets_[around[1]].corners, a, b));
      const auto isFlat = [&]
      {
        const auto& others = facets_[around[around[0] == static_cast<Index>(f) ? 1 : 0]].corners;
        return std::all_of(
          others.begin(), others.end(), [&](Index v) { return isInSpanOf(corners, v); });
      };
      if (segmentOf(a, b) < 0 && !areAlike)
      {
        addSegment({ { a, b }, ownLabel, -1, classBeside(a, b) });
      }
      else if (segmentOf(a, b) < 0 && facets_[around[0]].label < 0 && !isFlat())
      {
        addSegment({ { a, b }, creaseLabel });
      }
    }
  }
}

EdgeClass EditableMesh::classBeside(Index a, Index b) const
{
  const std::vector<Index> around = facets_.at(a, b);
  const bool isOnCAD = kind_ != Kind::Plane && std::any_of(around.begin(), around.end(),
                                                 [&](Index f) { return facets_[f].label >= 0; });
  return { isOnCAD ? EdgeClass::Smooth : EdgeClass::Straight, -1 };
}

void EditableMesh::setVertex(Index v, const Vertex& vertex)
{
  vertices_[v] = vertex;
  forgetQualities(v);
}

void EditableMesh::moveVertex(Index v, const Point3& point)
{
  vertices_[v].point = point;
  vertices_[v].wanted = point;
  forgetQualities(v);
}

bool EditableMesh::haveOneLabel(const std::vector<Index>& cells) const
{
  return std::all_of(cells.begin(), cells.end(),
    [&](Index cell) { return cells_[cell].label == cells_[cells.front()].label; });
}

bool EditableMesh::labelsEndAtFacets(Index v) const
{
  const std::vector<Index>& cells = cells_.at(v);
  if (haveOneLabel(cells))
  {
    return true;
  }
  for (std::size_t i = 1; i < cells.size(); ++i)
  {
    const LabelledSimplex<4>& cell = cells_[cells[i]];
    for (std::size_t k = 0; k < i; ++k)
    {
      const LabelledSimplex<4>& other = cells_[cells[k]];
      if (cell.label == other.label)
      {
        continue;
      }
      std::array<Index, 3> common{};
      std::size_t count = 0;
      for (const Index corner : cell.corners)
      {
        if (hasCorner(other.corners, corner))
        {
          common[count++] = corner;
        }
      }
      if (count == 3 && !hasFacet(common))
      {
        return false;
      }
    }
  }
  return true;
}

EditableMesh::Freedom EditableMesh::freedomOf(Index v) const
{
  const std::vector<Index>& segments = segments_.at(v);
  if (vertices_[v].stays || vertices_[v].isOnRim || !labelsEndAtFacets(v))
  {
    return Freedom::None;
  }
  if (segments.empty())
  {
    return facets_.at(v).empty() ? Freedom::Space : Freedom::Facet;
  }
  const LabelledSimplex<2>& segment = segments_[segments.front()];
  if (kind_ != Kind::Solid && segments.size() == 1)
  {
    return segment.label != ownLabel && segment.parent < 0 ? Freedom::Segment : Freedom::None;
  }
  const bool continues = segments.size() == 2 && segment.label != ownLabel &&
                         segment.label == segments_[segments[1]].label;
  return continues ? Freedom::Segment : Freedom::None;
}

bool EditableMesh::hasFacet(const std::array<Index, 3>& corners) const
{
  const std::vector<Index>& list = facets_.at(corners[0]);
  return std::any_of(list.begin(), list.end(),
    [&](Index facet)
    {
      return hasCorner(facets_[facet].corners, corners[1]) &&
             hasCorner(facets_[facet].corners, corners[2]);
    });
}

namespace
{

/// Rounding error of a distance from a plane or line through some of these points, whose
/// coordinates may be middles of middles.
double roundingOf(const std::vector<Point3>& points)
{
  double size = 0;
  for (const Point3& point : points)
  {
    for (const double x : point)
    {
      size = std::max(size, std::abs(x));
    }
  }
  return 1e-13 * size;
}

} // namespace

bool EditableMesh::isInSpanOf(const std::array<Index, 3>& facet, Index v) const
{
  const auto at = [&](int k) -> const Point3& { return vertices_[facet[k]].point; };
  const Point3& point = vertices_[v].point;
  const Vector3 normal = normalized(twofoldAreaVector(at(0), at(1), at(2)));
  return std::abs(dot(normal, point - at(0))) <= roundingOf({ at(0), at(1), at(2), point });
}

bool EditableMesh::isInSpanOf(const std::array<Index, 2>& segment, Index v) const
{
  const auto at = [&](int k) -> const Point3& { return vertices_[segment[k]].point; };
  const Point3& point = vertices_[v].point;
  const Vector3 direction = normalized(at(1) - at(0));
  return norm(cross(direction, point - at(0))) <= roundingOf({ at(0), at(1), point });
}

Index EditableMesh::segmentOf(Index a, Index b) const
{
  const std::vector<Index>& list = segments_.at(a);
  const auto found = std::find_if(list.begin(), list.end(),
    [&](Index segment) { return hasCorner(segments_[segment].corners, b); });
  return found == list.end() ? -1 : *found;
}

double EditableMesh::quality(const std::array<Index, 4>& cell) const
{
  return meanRatio(vertices_[cell[0]].wanted, vertices_[cell[1]].wanted, vertices_[cell[2]].wanted,
    vertices_[cell[3]].wanted);
}

double EditableMesh::currentQuality(const std::array<Index, 4>& cell) const
{
  return meanRatio(vertices_[cell[0]].point, vertices_[cell[1]].point, vertices_[cell[2]].point,
    vertices_[cell[3]].point);
}

double EditableMesh::quality(const std::array<Index, 3>& cell) const
{
  const auto at = [&](int k) -> const Point3& { return vertices_[cell[k]].wanted; };
  const int turn = turnOf(at(0), at(1), at(2), plane_ != Vector3{} ? plane_ : areaVector(cell));
  return std::copysign(meanRatio(at(0), at(1), at(2)), turn);
}

double EditableMesh::currentQuality(const std::array<Index, 3>& cell) const
{
  return meanRatio(vertices_[cell[0]].point, vertices_[cell[1]].point, vertices_[cell[2]].point);
}

bool EditableMesh::isValid(const std::array<Index, 4>& cell, const Vector3&) const
{
  return isPositive(vertices_[cell[0]].point, vertices_[cell[1]].point, vertices_[cell[2]].point,
    vertices_[cell[3]].point);
}

bool EditableMesh::isValid(const std::array<Index, 3>& cell, const Vector3& side) const
{
  return turnOf(vertices_[cell[0]].point, vertices_[cell[1]].point, vertices_[cell[2]].point,
           plane_ != Vector3{} ? plane_ : side) > 0;
}

double EditableMesh::qualityOf(Index cell) const
{
  const auto number = static_cast<std::size_t>(cell);
  if (number >= qualities_.size())
  {
    qualities_.resize(kind_ == Kind::Solid ? cells_.size() : facets_.size(),
      std::numeric_limits<double>::quiet_NaN());
  }
  double& known = qualities_[number];
  if (std::isnan(known))
  {
    known = kind_ == Kind::Solid ? quality(cells_[cell].corners) : quality(facets_[cell].corners);
  }
  return known;
}

void EditableMesh::forgetQualities(Index v)
{
  for (const Index cell : kind_ == Kind::Solid ? cells_.at(v) : facets_.at(v))
  {
    if (static_cast<std::size_t>(cell) < qualities_.size())
    {
      qualities_[cell] = std::numeric_limits<double>::quiet_NaN();
    }
  }
}

double EditableMesh::worst(const std::vector<Index>& cells) const
{
  double result = std::numeric_limits<double>::infinity();
  for (const Index cell : cells)
  {
    result = std::min(result, qualityOf(cell));
  }
  return result;
}

bool EditableMesh::isValid(const Cavity& cavity) const
{
  for (std::size_t f = 0; f < cavity.newFacets.size() && kind_ != Kind::Solid; ++f)
  {
    if (!isValid(cavity.newFacets[f].corners, cavity.sides[f]))
    {
      return false;
    }
  }
  return std::all_of(cavity.newCells.begin(), cavity.newCells.end(),
    [&](const auto& cell) { return isValid(cell.corners); });
}

Vector3 EditableMesh::areaVector(const std::array<Index, 3>& facet) const
{
  return twofoldAreaVector(
    vertices_[facet[0]].point, vertices_[facet[1]].point, vertices_[facet[2]].point);
}

Vector3 EditableMesh::sideOf(const std::vector<Index>& facets) const
{
  Vector3 sum{};
  for (const Index facet : facets)
  {
    sum = sum + areaVector(facets_[facet].corners);
  }
  return sum;
}

bool EditableMesh::touchesBoundary(const Cavity& cavity) const
{
  return kind_ == Kind::Plane ? !cavity.segments.empty() || !cavity.newSegments.empty()
                              : !cavity.facets.empty() || !cavity.newFacets.empty();
}

void EditableMesh::replace(const Cavity& cavity)
{
  const auto exchange = [](auto& store, const auto& removed, const auto& added)
  {
    for (const Index simplex : removed)
    {
      store.remove(simplex);
    }
    for (const auto& simplex : added)
    {
      store.add(simplex);
    }
  };
  exchange(cells_, cavity.cells, cavity.newCells);
  exchange(facets_, cavity.facets, cavity.newFacets);
  exchange(segments_, cavity.segments, cavity.newSegments);
}

Cavity EditableMesh::takeBack(const std::vector<Cavity>& done)
{
  Cavity whole;
  const auto gather = [&](auto& store, auto removedOf, auto addedOf)
  {
    std::size_t size = store.size(); // before
    for (const Cavity& cavity : done)
    {
      size -= (cavity.*addedOf).size();
    }
    std::vector<Index>& removed = whole.*removedOf;
    for (const Cavity& cavity : done)
    {
      const std::vector<Index>& list = cavity.*removedOf;
      std::copy_if(list.begin(), list.end(), std::back_inserter(removed),
        [&](Index simplex) { return static_cast<std::size_t>(simplex) < size; });
    }
    for (std::size_t s = size; s < store.size(); ++s)
    {
      if (store.exists(static_cast<Index>(s)))
      {
        (whole.*addedOf).push_back(store[static_cast<Index>(s)]);
      }
    }
    store.takeBack(size, removed);
  };
  gather(cells_, &Cavity::cells, &Cavity::newCells);
  gather(facets_, &Cavity::facets, &Cavity::newFacets);
  gather(segments_, &Cavity::segments, &Cavity::newSegments);
  whole.sides.assign(kind_ == Kind::Solid ? 0 : whole.newFacets.size(), sideOf(whole.facets));
  qualities_.resize(
    std::min(qualities_.size(), kind_ == Kind::Solid ? cells_.size() : facets_.size()));
  return whole;
}

} // namespace cadrefine
