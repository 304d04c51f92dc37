#include <cadrefine/operations/Operations.h>

#include <cadrefine/base/SortUniquely.h>
#include <cadrefine/operations/TriangleOperations.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace cadrefine
{
namespace
{

constexpr double impossible = -std::numeric_limits<double>::infinity();

template<std::size_t Corners>
std::array<Index, Corners> withCorner(std::array<Index, Corners> corners, Index from, Index to)
{
  std::replace(corners.begin(), corners.end(), from, to);
  return corners;
}

/// The other two corners of a cell at the edge (a, b): so that (a, b, first, second) turns as the
/// cell does.
std::array<Index, 2> acrossEdge(const std::array<Index, 4>& cell, Index a, Index b)
{
  for (const auto& [i, j] : tetrahedronEdges)
  {
    const bool isForward = cell[i] == a && cell[j] == b;
    if (isForward || (cell[i] == b && cell[j] == a))
    {
      std::array<Index, 2> others{};
      std::size_t count = 0;
      for (int k = 0; k < 4; ++k)
      {
        if (k != i && k != j)
        {
          others[count++] = cell[k];
        }
      }
      // (0, 2) and (1, 3) need an odd permutation to come first.
      const bool isOdd = (i + j) % 2 == 0;
      if (isOdd == isForward)
      {
        std::swap(others[0], others[1]);
      }
      return others;
    }
  }
  return { -1, -1 };
}

/// The vertices round an edge, in the order in which they turn round it from a to b. A closed ring
/// has as many as cells, one that ends at facets one more.
struct Ring
{
  std::vector<Index> vertices;
  bool isClosed = true;
};

/// The ring of these cells, all those round an edge; empty where they do not make one ring of the
/// size that is allowed.
Ring ringOf(const EditableMesh& mesh, const std::vector<Index>& cells, Index a, Index b)
{
  if (cells.size() > largestRing)
  {
    return {};
  }
  std::vector<std::array<Index, 2>> links;
  links.reserve(cells.size());
  for (const Index cell : cells)
  {
    links.push_back(acrossEdge(mesh.cells()[cell].corners, a, b));
  }
  const auto linkFrom = [&](Index vertex)
  {
    return std::find_if(
      links.begin(), links.end(), [&](const auto& link) { return link[0] == vertex; });
  };
  const auto first = std::find_if(links.begin(), links.end(),
    [&](const auto& link)
    {
      return std::none_of(
        links.begin(), links.end(), [&](const auto& other) { return other[1] == link[0]; });
    });
  Ring ring;
  ring.isClosed = first == links.end();
  const Index start = ring.isClosed ? links.front()[0] : (*first)[0];
  Index vertex = start;
  do
  {
    ring.vertices.push_back(vertex);
    const auto link = linkFrom(vertex);
    vertex = link == links.end() ? -1 : (*link)[1];
  } while (vertex >= 0 && vertex != start && ring.vertices.size() <= links.size());
  const bool isWhole = ring.vertices.size() == links.size() + (ring.isClosed ? 0 : 1);
  return isWhole && ring.vertices.size() <= largestRing ? ring : Ring{ {}, true };
}

/// Whether an edge may have cells beyond the mesh: if both ends have, unless these are no simplices
/// and the edge's cells are a closed ring. (Where simplices follow, other blocks have their turn.)
bool mayGoBeyond(const EditableMesh& mesh, const Ring& ring, Index a, Index b)
{
  const bool isClosed = !ring.vertices.empty() && ring.isClosed && mesh.facets().at(a, b).empty();
  const bool areBesideOthers = mesh.vertex(a).isBesideOthers && mesh.vertex(b).isBesideOthers;
  return mesh.areOnRim(a, b) && !(isClosed && areBesideOthers);
}

/// The triangulation of a ring with the best worst cell, if that is no worse than `least`.
class RingTriangulation
{
public:
  RingTriangulation(
    const EditableMesh& mesh, const std::vector<Index>& ring, Index a, Index b, double least)
    : mesh_(mesh), ring_(ring), a_(a), b_(b), least_(least)
  {
    const std::size_t count = ring.size();
    for (std::size_t length = 2; length < count; ++length)
    {
      for (std::size_t i = 0; i + length < count; ++i)
      {
        findBest(i, i + length);
      }
    }
  }

  bool isPossible() const { return best(0, ring_.size() - 1) > impossible; }

  template<class Visit>
  void forTriangles(const Visit& visit) const
  {
    visitBetween(0, ring_.size() - 1, visit);
  }

  /// The two cells over and below the triangle of these ring vertices.
  std::array<std::array<Index, 4>, 2> cellsAt(std::size_t i, std::size_t j, std::size_t k) const
  {
    return { { { ring_[i], ring_[j], ring_[k], b_ }, { ring_[i], ring_[k], ring_[j], a_ } } };
  }

private:
  double best(std::size_t i, std::size_t j) const
  {
    return j - i < 2 ? std::numeric_limits<double>::infinity() : best_[i][j];
  }

  /// Quality of the worse of the two cells at a triangle, or `impossible`; the cheaper check comes
  /// first.
  double worstAt(std::size_t i, std::size_t k, std::size_t j) const
  {
    const auto cells = cellsAt(i, k, j);
    double worst = std::numeric_limits<double>::infinity();
    for (const auto& cell : cells)
    {
      worst = std::min(worst, mesh_.quality(cell));
      if (worst < least_)
      {
        return impossible;
      }
    }
    return mesh_.isValid(cells[0]) && mesh_.isValid(cells[1]) ? worst : impossible;
  }

  void findBest(std::size_t i, std::size_t j)
  {
    best_[i][j] = impossible;
    apex_[i][j] = i + 1;
    for (std::size_t k = i + 1; k < j; ++k)
    {
      const double others = std::min(best(i, k), best(k, j));
      const double worst = others > best_[i][j] ? std::min(others, worstAt(i, k, j)) : impossible;
      if (worst > best_[i][j])
      {
        best_[i][j] = worst;
        apex_[i][j] = k;
      }
    }
  }

  template<class Visit>
  void visitBetween(std::size_t i, std::size_t j, const Visit& visit) const
  {
    if (j - i >= 2)
    {
      const std::size_t k = apex_[i][j];
      visit(i, k, j);
      visitBetween(i, k, visit);
      visitBetween(k, j, visit);
    }
  }

  const EditableMesh& mesh_;
  const std::vector<Index>& ring_;
  Index a_;
  Index b_;
  double least_;
  std::array<std::array<double, largestRing>, largestRing> best_{};
  std::array<std::array<std::size_t, largestRing>, largestRing> apex_{};
};

/// The corners of these cells, each once, ascending, but for two vertices.
template<std::size_t Corners>
std::vector<Index> otherCorners(
  const SimplexStore<Corners>& store, const std::vector<Index>& cells, Index a, Index b)
{
  std::vector<Index> result;
  for (const Index cell : cells)
  {
    const auto& corners = store[cell].corners;
    std::copy_if(corners.begin(), corners.end(), std::back_inserter(result),
      [&](Index vertex) { return vertex != a && vertex != b; });
  }
  sortUniquely(result);
  return result;
}

/// Whether the vertices that are joined to both ends of an edge are those of the cells round it.
template<std::size_t Corners>
bool keepsLinks(const SimplexStore<Corners>& cells, Index a, Index b)
{
  const std::vector<Index> ofA = otherCorners(cells, cells.at(a), a, b);
  const std::vector<Index> ofB = otherCorners(cells, cells.at(b), a, b);
  std::vector<Index> common;
  std::set_intersection(ofA.begin(), ofA.end(), ofB.begin(), ofB.end(), std::back_inserter(common));
  return common == otherCorners(cells, cells.at(a, b), a, b);
}

/// Whether a vertex that goes along an edge does not pinch the boundary together: no edge of facets
/// comes to lie on another one, but for those of the facets at the edge.
bool keepsFacets(const EditableMesh& mesh, Index from, Index to)
{
  const SimplexStore<3>& facets = mesh.facets();
  const std::vector<Index> beside = otherCorners(facets, facets.at(from, to), from, to);
  const std::vector<Index> around = otherCorners(facets, facets.at(from), from, to);
  return std::all_of(around.begin(), around.end(),
    [&](Index vertex)
    {
      return std::binary_search(beside.begin(), beside.end(), vertex) ||
             (facets.at(to, vertex).empty() && !mesh.areOnRim(to, vertex));
    });
}

/// Whether a vertex may go along this edge.
bool mayGo(const EditableMesh& mesh, Index from, Index to)
{
  const std::size_t facets = mesh.facets().at(from, to).size();
  // The border of triangles has one facet; between cells of several labels more than two may meet.
  const bool isOfFacets = mesh.dimension() == 3 ? facets >= 2 : facets == 1 || facets == 2;
  switch (mesh.freedomOf(from))
  {
    case EditableMesh::Freedom::Space:
      return true;
    case EditableMesh::Freedom::Facet:
      return facets == 2;
    case EditableMesh::Freedom::Segment:
      return mesh.segmentOf(from, to) >= 0 && isOfFacets;
    default:
      return false;
  }
}

/// Removes the simplices at `from`, and adds those without `to` again with `to` in its place.
template<std::size_t Corners>
void collapse(const SimplexStore<Corners>& store, Index from, Index to, std::vector<Index>& removed,
  std::vector<LabelledSimplex<Corners>>& added)
{
  removed = store.at(from);
  for (const Index simplex : removed)
  {
    LabelledSimplex<Corners> next = store[simplex];
    if (!hasCorner(next.corners, to))
    {
      next.corners = withCorner(next.corners, from, to);
      added.push_back(next);
    }
  }
}

/// A segment in place of two on different CAD edges no longer names one: it is on a crease of them.
void joinClasses(const EditableMesh& mesh, Cavity& cavity)
{
  const auto isOnAnother = [&](Index old, const EdgeClass& edgeClass)
  { return mesh.segments()[old].edgeClass.entity != edgeClass.entity; };
  for (auto& segment : cavity.newSegments)
  {
    if (std::any_of(cavity.segments.begin(), cavity.segments.end(),
          [&](Index old) { return isOnAnother(old, segment.edgeClass); }))
    {
      segment.edgeClass.entity = -1;
    }
  }
}

template<std::size_t Corners>
void halve(const SimplexStore<Corners>& store, Index a, Index b, Index middle,
  const std::vector<Index>& removed, std::vector<LabelledSimplex<Corners>>& added)
{
  for (const Index simplex : removed)
  {
    for (const Index end : { a, b })
    {
      LabelledSimplex<Corners> half = store[simplex];
      half.corners = withCorner(half.corners, end, middle);
      added.push_back(half);
    }
  }
}

} // namespace

bool proposeEdgeRemoval(
  const EditableMesh& mesh, Index a, Index b, Cavity& cavity, NewCells newCells)
{
  if (mesh.dimension() == 2)
  {
    return proposeSwap(mesh, a, b, cavity);
  }
  cavity.clear();
  if (mesh.segmentOf(a, b) >= 0)
  {
    return false;
  }
  mesh.cells().at(a, b, cavity.cells);
  const Ring ring = ringOf(mesh, cavity.cells, a, b);
  if (ring.vertices.empty() || mayGoBeyond(mesh, ring, a, b) || !mesh.haveOneLabel(cavity.cells))
  {
    return false;
  }
  const std::vector<Index>& r = ring.vertices;
  mesh.facets().at(a, b, cavity.facets);
  if (cavity.facets.size() != (ring.isClosed ? 0 : 2) || (ring.isClosed && r.size() < 3))
  {
    return false;
  }
  if (!ring.isClosed)
  {
    const Index first = r.front();
    const Index last = r.back();
    const bool isThere = !mesh.facets().at(first, last).empty() ||
                         (r.size() > 2 && !mesh.cells().at(first, last).empty());
    if (isThere || mesh.areOnRim(first, last))
    {
      return false;
    }
    const auto& one = mesh.facets()[cavity.facets[0]];
    const auto& other = mesh.facets()[cavity.facets[1]];
    const bool isFirst = hasCorner(one.corners, first);
    cavity.newFacets = { { { first, b, last }, one.label, isFirst ? one.parent : other.parent },
      { { first, last, a }, one.label, isFirst ? other.parent : one.parent } };
  }
  const double least = newCells == NewCells::NoWorse ? mesh.worst(cavity.cells) : impossible;
  const RingTriangulation triangulation(mesh, r, a, b, least);
  if (!triangulation.isPossible())
  {
    return false;
  }
  const Index label = mesh.cells()[cavity.cells.front()].label;
  triangulation.forTriangles(
    [&](std::size_t i, std::size_t j, std::size_t k)
    {
      for (const auto& corners : triangulation.cellsAt(i, j, k))
      {
        cavity.newCells.push_back({ corners, label });
      }
    });
  return true;
}

bool proposeFaceRemoval(const EditableMesh& mesh, Index cell, int corner, Cavity& cavity)
{
  cavity.clear();
  const auto& corners = mesh.cells()[cell].corners;
  std::array<Index, 3> face{};
  std::transform(std::begin(tetrahedronFaces[corner]), std::end(tetrahedronFaces[corner]),
    face.begin(), [&](int k) { return corners[k]; });
  const std::vector<Index> around = mesh.cells().at(face[0], face[1]);
  const auto beyond = std::find_if(around.begin(), around.end(),
    [&](Index c) { return c != cell && hasCorner(mesh.cells()[c].corners, face[2]); });
  if (beyond == around.end() || mesh.cells()[*beyond].label != mesh.cells()[cell].label ||
      mesh.hasFacet(face))
  {
    return false;
  }
  const auto& others = mesh.cells()[*beyond].corners;
  const Index apex = *std::find_if(
    others.begin(), others.end(), [&](Index vertex) { return !hasCorner(face, vertex); });
  cavity.cells = { cell, *beyond };
  for (int k = 0; k < 3; ++k)
  {
    cavity.newCells.push_back(
      { { corners[corner], face[k], face[(k + 1) % 3], apex }, mesh.cells()[cell].label });
  }
  return true;
}

bool proposeCollapse(const EditableMesh& mesh, Index from, Index to, Cavity& cavity)
{
  cavity.clear();
  const bool isSolid = mesh.dimension() == 3;
  if (!mayGo(mesh, from, to) || (isSolid && !keepsFacets(mesh, from, to)) ||
      !(isSolid ? keepsLinks(mesh.cells(), from, to) : keepsLinks(mesh.facets(), from, to)))
  {
    return false;
  }
  collapse(mesh.cells(), from, to, cavity.cells, cavity.newCells);
  collapse(mesh.facets(), from, to, cavity.facets, cavity.newFacets);
  collapse(mesh.segments(), from, to, cavity.segments, cavity.newSegments);
  joinClasses(mesh, cavity);
  return (isSolid || findSidesOfCollapse(mesh, from, to, cavity)) &&
         std::none_of(cavity.newFacets.begin(), cavity.newFacets.end(),
           [&](const auto& facet) { return mesh.hasFacet(facet.corners); }) &&
         std::none_of(cavity.newSegments.begin(), cavity.newSegments.end(),
           [&](const auto& segment)
           { return mesh.segmentOf(segment.corners[0], segment.corners[1]) >= 0; });
}

void halve(const EditableMesh& mesh, Index a, Index b, Index middle, Cavity& cavity)
{
  halve(mesh.cells(), a, b, middle, cavity.cells, cavity.newCells);
  halve(mesh.facets(), a, b, middle, cavity.facets, cavity.newFacets);
  halve(mesh.segments(), a, b, middle, cavity.segments, cavity.newSegments);
}

bool proposeSplit(const EditableMesh& mesh, Index a, Index b, Index middle, Cavity& cavity)
{
  cavity.clear();
  mesh.cells().at(a, b, cavity.cells);
  const Ring ring = mesh.dimension() == 3 ? ringOf(mesh, cavity.cells, a, b) : Ring{};
  if (mayGoBeyond(mesh, ring, a, b))
  {
    return false;
  }
  mesh.facets().at(a, b, cavity.facets);
  mesh.segments().at(a, b, cavity.segments);
  halve(mesh, a, b, middle, cavity);
  if (mesh.dimension() == 2)
  {
    findSidesOfSplit(mesh, cavity);
    return !cavity.facets.empty();
  }
  return !cavity.cells.empty();
}

} // namespace cadrefine
