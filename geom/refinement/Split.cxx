#include <cadrefine/refinement/Split.h>

#include <cadrefine/base/LargeMemory.h>
#include <cadrefine/base/PieceLimit.h>
#include <cadrefine/mesh/CellState.h>
#include <cadrefine/refinement/Bisection.h>
#include <cadrefine/refinement/CellCutting.h>

#include <algorithm>
#include <numeric>
#include <type_traits>
#include <utility>

namespace cadrefine
{
namespace
{

/// visit(shape, first, cells) of the cells of volume that are not simplices, `first` being the
/// number of the first one.
template<class Visit>
void visitOthers(const SimplexMesh& mesh, const Visit& visit)
{
  auto first = static_cast<Index>(mesh.tetrahedra.size());
  const auto visitOne = [&](auto shape)
  {
    const auto& cells = mesh.*decltype(shape)::cells;
    visit(shape, first, cells);
    first += static_cast<Index>(cells.size());
  };
  visitOne(shapes::Pyramid{});
  visitOne(shapes::Wedge{});
  visitOne(shapes::Hexahedron{});
}

/// The corners of the cells in whose middle a vertex is, in their order.
template<class Use>
void forCornersOfCells(const SimplexMesh& mesh, const Midpoints& midpoints, const Use& use)
{
  auto next = midpoints.cells.begin();
  visitOthers(mesh,
    [&](auto, Index first, const auto& cells)
    {
      const Index end = first + static_cast<Index>(cells.size());
      for (; next != midpoints.cells.end() && *next < end; ++next)
      {
        use(cells[*next - first]);
      }
    });
}

/// What parts the corners of a cell have in the vertex in its middle: all the same, but that of a
/// pyramid is higher over its base than their mean, as a base that is not plane rises; in one whose
/// edges are equal it is as far from all sides.
template<std::size_t Corners>
constexpr std::array<double, Corners> partsInMiddle(const std::array<Index, Corners>&)
{
  if constexpr (Corners == shapes::Pyramid::corners)
  {
    return { 5.0 / 32, 5.0 / 32, 5.0 / 32, 5.0 / 32, 3.0 / 8 };
  }
  std::array<double, Corners> parts{};
  for (double& part : parts)
  {
    part = 1.0 / static_cast<double>(Corners);
  }
  return parts;
}

void appendNewPoints(
  const SimplexMesh& mesh, const Midpoints& midpoints, std::vector<Point3>& points)
{
  const std::size_t halves = midpoints.parentEdges.size() - midpoints.cells.size();
  for (std::size_t n = 0; n < halves; ++n)
  {
    const auto& [a, b] = midpoints.parentEdges[n];
    points.push_back(0.5 * (points[a] + points[b]));
  }
  forCornersOfCells(mesh, midpoints,
    [&](const auto& corners)
    {
      const auto parts = partsInMiddle(corners);
      Point3 middle{};
      for (std::size_t k = 0; k < corners.size(); ++k)
      {
        middle = middle + parts[k] * points[corners[k]];
      }
      points.push_back(middle);
    });
}

/// The split mesh with its points but without cells.
SplitMesh withNewPoints(
  const SimplexMesh& mesh, const Midpoints& midpoints, const std::vector<GlobalId>& ids)
{
  SplitMesh result;
  result.mesh.dimension = mesh.dimension;
  result.mesh.wedgesAsDocumented = mesh.wedgesAsDocumented;
  const std::size_t count = mesh.points.size() + midpoints.parentEdges.size();
  reserveLong(result.mesh.points, count);
  reserveLong(result.mesh.ids, count);
  result.mesh.points.assign(mesh.points.begin(), mesh.points.end());
  result.mesh.ids.assign(mesh.ids.begin(), mesh.ids.end());
  appendNewPoints(mesh, midpoints, result.mesh.points);
  result.mesh.ids.insert(result.mesh.ids.end(), ids.begin(), ids.end());
  result.parentEdges = midpoints.parentEdges;
  return result;
}

/// Children of one cell after the other.
class ChildCount
{
public:
  explicit ChildCount(std::size_t cells)
  {
    reserveLong(firsts_, cells + 1);
    firsts_.push_back(0);
  }

  void add(std::size_t children)
  {
    total_ += children;
    firsts_.push_back(static_cast<Index>(total_));
  }

  /// Where those of each cell begin. Throws Error where they are too many for one rank.
  std::vector<Index> finish()
  {
    requireAtMost(total_, "cells");
    return std::move(firsts_);
  }

private:
  std::vector<Index> firsts_;
  std::size_t total_ = 0;
};

/// Every cell has as many children.
std::vector<Index> evenChildren(std::size_t cells, Index children)
{
  requireAtMost(cells * static_cast<std::size_t>(children), "cells");
  std::vector<Index> firsts(cells + 1);
  for (std::size_t c = 0; c < firsts.size(); ++c)
  {
    firsts[c] = static_cast<Index>(c) * children;
  }
  return firsts;
}

void splitSegments(
  const SimplexMesh& mesh, const EdgeTable& table, const Midpoints& midpoints, SplitMesh& result)
{
  result.mesh.segments.reserve(result.firstChildren[1].back());
  for (std::size_t c = 0; c < mesh.segments.size(); ++c)
  {
    const auto& cell = mesh.segments[c];
    const Index m = midpoints.ofEdge[table.ofSegments[c][0]];
    if (m < 0)
    {
      result.mesh.segments.push_back(cell);
    }
    else
    {
      result.mesh.segments.push_back({ cell[0], m });
      result.mesh.segments.push_back({ m, cell[1] });
    }
  }
}

template<std::size_t Corners, std::size_t Edges>
void bisectAll(const Simplices<Corners>& cells, const std::vector<std::array<Index, Edges>>& edges,
  const EdgeOrder& order, const Midpoints& midpoints, const std::vector<Index>& firstChildren,
  Simplices<Corners>& children)
{
  reserveLong(children, firstChildren.back());
  const auto vertexOf = [&](Index edge) { return midpoints.ofEdge[edge]; };
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    if (firstChildren[c + 1] - firstChildren[c] == 1)
    {
      children.push_back(cells[c]);
    }
    else
    {
      bisect(Part<Corners, Edges>{ cells[c], edges[c] }, order, vertexOf,
        [&](const std::array<Index, Corners>& child) { children.push_back(child); });
    }
  }
}

template<std::size_t Corners, std::size_t Edges>
std::vector<Index> countParts(const std::vector<std::array<Index, Edges>>& cellEdges,
  const EdgeOrder& order, const EdgeMarks& marks)
{
  const auto vertexOf = [&](Index edge) { return marks[edge] ? 0 : -1; };
  ChildCount count(cellEdges.size());
  for (const auto& edges : cellEdges)
  {
    std::size_t children = 1;
    if (std::any_of(edges.begin(), edges.end(), [&](Index edge) { return marks[edge] != 0; }))
    {
      children = 0;
      bisect(Part<Corners, Edges>{ {}, edges }, order, vertexOf, [&](const auto&) { ++children; });
    }
    count.add(children);
  }
  return count.finish();
}

void splitTriangleUniformly(
  const std::array<Index, 3>& v, const std::array<Index, 3>& m, Simplices<3>& children)
{
  children.push_back({ v[0], m[0], m[2] });
  children.push_back({ m[0], v[1], m[1] });
  children.push_back({ m[2], m[1], v[2] });
  children.push_back({ m[0], m[1], m[2] });
}

/// The three diagonals of the octahedron between the corners, each as two midpoints and the ring of
/// the other four, in terms of the tetrahedron's local edges.
constexpr int diagonals[3][2] = { { 0, 5 }, { 1, 4 }, { 2, 3 } };
constexpr int rings[3][4] = { { 1, 3, 4, 2 }, { 2, 5, 3, 0 }, { 0, 4, 5, 1 } };

/// Whether diagonal (a, b) is shorter than (c, d); ties by the ids of their ends.
bool shorterDiagonal(const SimplexMesh& mesh, std::array<Index, 2> ab, std::array<Index, 2> cd)
{
  const auto inIdOrder = [&](std::array<Index, 2>& ends)
  {
    if (mesh.ids[ends[1]] < mesh.ids[ends[0]])
    {
      std::swap(ends[0], ends[1]);
    }
    return squaredNorm(mesh.points[ends[1]] - mesh.points[ends[0]]);
  };
  const double first = inIdOrder(ab);
  const double second = inIdOrder(cd);
  return first != second ? first < second : mesh.ids[ab[0]] < mesh.ids[cd[0]];
}

void splitTetrahedronUniformly(const SimplexMesh& mesh, const std::array<Index, 4>& v,
  const std::array<Index, 6>& m, Simplices<4>& children)
{
  children.push_back({ v[0], m[0], m[1], m[2] });
  children.push_back({ m[0], v[1], m[3], m[4] });
  children.push_back({ m[1], m[3], v[2], m[5] });
  children.push_back({ m[2], m[4], m[5], v[3] });
  int best = 0;
  for (int k = 1; k < 3; ++k)
  {
    if (shorterDiagonal(mesh, { m[diagonals[k][0]], m[diagonals[k][1]] },
          { m[diagonals[best][0]], m[diagonals[best][1]] }))
    {
      best = k;
    }
  }
  for (int k = 0; k < 4; ++k)
  {
    children.push_back({ m[diagonals[best][0]], m[diagonals[best][1]], m[rings[best][(k + 1) % 4]],
      m[rings[best][k]] });
  }
}

/// The new vertices of edges, or of quadrilaterals.
template<std::size_t Count>
std::array<Index, Count> midpointsOf(
  const std::array<Index, Count>& items, const std::vector<Index>& midpointOf)
{
  std::array<Index, Count> result;
  std::transform(
    items.begin(), items.end(), result.begin(), [&](Index item) { return midpointOf[item]; });
  return result;
}

/// With m on the edges and one vertex in the middle.
void splitQuadrilateralUniformly(const std::array<Index, 4>& v, const std::array<Index, 4>& m,
  Index middle, Simplices<4>& children)
{
  children.push_back({ v[0], m[0], middle, m[3] });
  children.push_back({ m[0], v[1], m[1], middle });
  children.push_back({ middle, m[1], v[2], m[2] });
  children.push_back({ m[3], middle, m[2], v[3] });
}

/// With m on the edges and one vertex in the base.
void splitPyramidUniformly(const std::array<Index, 5>& v, const std::array<Index, 8>& m, Index base,
  Simplices<5>& pyramids, Simplices<4>& tetrahedra)
{
  pyramids.push_back({ v[0], m[0], base, m[3], m[4] });
  pyramids.push_back({ m[0], v[1], m[1], base, m[5] });
  pyramids.push_back({ base, m[1], v[2], m[2], m[6] });
  pyramids.push_back({ m[3], base, m[2], v[3], m[7] });
  pyramids.push_back({ m[4], m[5], m[6], m[7], v[4] });
  pyramids.push_back({ m[4], m[7], m[6], m[5], base });
  for (int k = 0; k < 4; ++k)
  {
    tetrahedra.push_back({ m[k], base, m[4 + k], m[4 + (k + 1) % 4] });
  }
}

/// With m on the edges and q in the quadrilaterals: four wedges over each half of the height.
void splitWedgeUniformly(const std::array<Index, 6>& v, const std::array<Index, 9>& m,
  const std::array<Index, 3>& q, Simplices<6>& children)
{
  const std::array<Index, 6> levels[3] = { { v[0], v[1], v[2], m[0], m[1], m[2] },
    { m[6], m[7], m[8], q[0], q[1], q[2] }, { v[3], v[4], v[5], m[3], m[4], m[5] } };
  constexpr int triangles[4][3] = { { 0, 3, 5 }, { 3, 1, 4 }, { 5, 4, 2 }, { 3, 4, 5 } };
  for (int level = 0; level < 2; ++level)
  {
    for (const auto& [a, b, c] : triangles)
    {
      const auto& low = levels[level];
      const auto& high = levels[level + 1];
      children.push_back({ low[a], low[b], low[c], high[a], high[b], high[c] });
    }
  }
}

/// Corners of a hexahedron in steps along its three directions.
constexpr int cornerSteps[8][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 },
  { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } };

/// With m on the edges, q in the faces and one vertex in the middle: a child at each corner.
void splitHexahedronUniformly(const std::array<Index, 8>& v, const std::array<Index, 12>& m,
  const std::array<Index, 6>& q, Index middle, Simplices<8>& children)
{
  Index lattice[3][3][3]; // of half the size of the hexahedron
  const auto at = [&](const int* corners, int count) -> Index&
  {
    int place[3] = { 0, 0, 0 };
    for (int k = 0; k < count; ++k)
    {
      for (int i = 0; i < 3; ++i)
      {
        place[i] += 2 * cornerSteps[corners[k]][i];
      }
    }
    return lattice[place[0] / count][place[1] / count][place[2] / count];
  };
  for (int k = 0; k < 8; ++k)
  {
    at(&k, 1) = v[k];
  }
  for (int e = 0; e < 12; ++e)
  {
    at(shapes::Hexahedron::edges[e], 2) = m[e];
  }
  for (int f = 0; f < 6; ++f)
  {
    at(shapes::Hexahedron::faces[f], 4) = q[f];
  }
  lattice[1][1][1] = middle;
  for (const auto& first : cornerSteps)
  {
    auto& child = children.emplace_back();
    for (int k = 0; k < 8; ++k)
    {
      const auto& step = cornerSteps[k];
      child[k] = lattice[first[0] + step[0]][first[1] + step[1]][first[2] + step[2]];
    }
  }
}

/// Numbers of the children of cells of one dimension, which are appended to the cells of several
/// shapes.
class ChildNumbering
{
public:
  ChildNumbering(const SimplexMesh& children, int dimension)
    : children_(children), dimension_(dimension)
  {
  }

  /// The children that were appended since the last time: those of one cell, or of several in turn
  /// that have children of the first shape alone.
  void take()
  {
    std::size_t shape = 0;
    visitShapes(children_, dimension_,
      [&](auto, const auto& cells)
      {
        for (std::size_t& count = counts_[shape]; count < cells.size(); ++count)
        {
          taken_.emplace_back(shape, count);
        }
        ++shape;
      });
  }

  std::vector<Index> finish() const
  {
    std::array<std::size_t, 4> firsts{};
    std::partial_sum(counts_.begin(), counts_.end() - 1, firsts.begin() + 1);
    std::vector<Index> numbers(taken_.size());
    std::transform(taken_.begin(), taken_.end(), numbers.begin(),
      [&](const std::pair<std::size_t, std::size_t>& child)
      { return static_cast<Index>(firsts[child.first] + child.second); });
    return numbers;
  }

private:
  const SimplexMesh& children_;
  int dimension_;
  std::array<std::size_t, 4> counts_{};
  std::vector<std::pair<std::size_t, std::size_t>> taken_; ///< Shape, and place among its cells.
};

/// Cuts all cells of volume that are not simplices; use(cell) after each, by its number.
template<class Use>
void cutOthers(const SimplexMesh& mesh, const CellCutting& cutting, const Midpoints& midpoints,
  SimplexMesh& children, const Use& use)
{
  auto next = midpoints.cells.begin();
  Index apex = midpoints.nextVertex() - static_cast<Index>(midpoints.cells.size());
  visitOthers(mesh,
    [&](auto shape, Index first, const auto& cells)
    {
      for (Index c = 0; c < static_cast<Index>(cells.size()); ++c)
      {
        const bool hasApex = next != midpoints.cells.end() && *next == first + c;
        cutting.cut(shape, c, hasApex ? apex++ : -1, children);
        next += hasApex;
        use(first + c);
      }
    });
}

template<class Use>
void cutQuadrilaterals(
  const SimplexMesh& mesh, const CellCutting& cutting, SimplexMesh& children, const Use& use)
{
  for (Index c = 0; c < static_cast<Index>(mesh.quadrilaterals.size()); ++c)
  {
    cutting.cut(shapes::Quadrilateral{}, c, children);
    use();
  }
}

void clearCells(SimplexMesh& mesh)
{
  visitShapes(mesh, [](auto, auto& cells) { cells.clear(); });
}

/// Whether the cell of volume of this number is valid.
bool isValid(const SimplexMesh& mesh, Index cell)
{
  bool valid = false;
  std::size_t first = 0;
  visitOwnShapes(mesh,
    [&](auto shape, const auto& cells)
    {
      const std::size_t place = static_cast<std::size_t>(cell) - first; // huge where it is below
      valid = valid || (place < cells.size() &&
                         stateAt(shape, cornersOf(cells[place], mesh.points), {}).valid);
      first += cells.size();
    });
  return valid;
}

/// Appends how many children cells that are not simplices have.
void countOthers(const SimplexMesh& mesh, const EdgeTable& table, const QuadTable& quads,
  const EdgeMarks& marks, ChildRanges& firsts)
{
  const Midpoints midpoints = makeMidpoints(mesh, table, quads, marks, false);
  const CellCutting cutting(mesh, table, quads, midpoints);
  SimplexMesh children;
  const auto count = [&](int dimension)
  {
    auto& list = firsts[dimension];
    const std::size_t total = list.back() + children.cellCount(dimension);
    requireAtMost(total, "cells");
    list.push_back(static_cast<Index>(total));
    clearCells(children);
  };
  cutQuadrilaterals(mesh, cutting, children, [&] { count(2); });
  cutOthers(mesh, cutting, midpoints, children, [&](Index) { count(3); });
}

void splitOthers(const SimplexMesh& mesh, const EdgeTable& table, const QuadTable& quads,
  const Midpoints& midpoints, SplitMesh& result)
{
  const CellCutting cutting(mesh, table, quads, midpoints);
  ChildNumbering flat(result.mesh, 2);
  flat.take();
  cutQuadrilaterals(mesh, cutting, result.mesh, [&] { flat.take(); });
  result.children[2] = flat.finish();
  ChildNumbering ofVolume(result.mesh, 3);
  ofVolume.take();
  cutOthers(mesh, cutting, midpoints, result.mesh, [&](Index) { ofVolume.take(); });
  result.children[3] = ofVolume.finish();
  Index vertex = midpoints.nextVertex() - static_cast<Index>(midpoints.cells.size());
  forCornersOfCells(mesh, midpoints,
    [&](const auto& corners)
    {
      const auto parts = partsInMiddle(corners);
      for (std::size_t k = 0; k < corners.size(); ++k)
      {
        result.ofVertices.add(corners[k], parts[k]);
      }
      result.ofVertices.endRow(vertex++);
    });
}

bool areValid(const SimplexMesh& cells, const std::vector<Point3>& points)
{
  bool valid = true;
  visitOwnShapes(cells,
    [&](auto shape, const auto& all)
    {
      valid = valid && std::all_of(all.begin(), all.end(),
                         [&](const auto& cell)
                         { return stateAt(shape, cornersOf(cell, points), {}).valid; });
    });
  return valid;
}

void addQuadMidpoints(const QuadTable& quads, Midpoints& midpoints)
{
  reserveLong(midpoints.ofQuad, quads.edges.size());
  for (std::size_t q = 0; q < quads.edges.size(); ++q)
  {
    const auto onEdges = midpointsOf(quads.edges[q], midpoints.ofEdge);
    const bool isCut = std::find(onEdges.begin(), onEdges.end(), -1) == onEdges.end();
    midpoints.ofQuad.push_back(isCut ? midpoints.nextVertex() : -1);
    if (isCut)
    {
      midpoints.parentEdges.push_back({ onEdges[0], onEdges[2] });
      midpoints.quads.push_back(static_cast<Index>(q));
    }
  }
}

void addHexahedronMidpoints(const QuadTable& quads, Midpoints& midpoints)
{
  constexpr int opposite[6] = { 1, 0, 4, 5, 2, 3 };
  reserveLong(midpoints.ofHexahedron, quads.ofHexahedra.size());
  for (std::size_t h = 0; h < quads.ofHexahedra.size(); ++h)
  {
    const auto& faces = quads.ofHexahedra[h];
    const auto inFaces = midpointsOf(faces, midpoints.ofQuad);
    const bool isCut = std::find(inFaces.begin(), inFaces.end(), -1) == inFaces.end();
    midpoints.ofHexahedron.push_back(isCut ? midpoints.nextVertex() : -1);
    if (isCut)
    {
      const auto smallest = std::min_element(faces.begin(), faces.end()) - faces.begin();
      midpoints.parentEdges.push_back({ inFaces[smallest], inFaces[opposite[smallest]] });
      midpoints.hexahedra.push_back(static_cast<Index>(h));
    }
  }
}

void addApexes(
  const SimplexMesh& mesh, const EdgeTable& table, const QuadTable& quads, Midpoints& midpoints)
{
  const CellCutting cutting(mesh, table, quads, midpoints);
  visitOthers(mesh,
    [&](auto shape, Index first, const auto& cells)
    {
      for (Index c = 0; c < static_cast<Index>(cells.size()); ++c)
      {
        if (cutting.needsApex(shape, c))
        {
          midpoints.cells.push_back(first + c);
          midpoints.parentEdges.push_back({ cells[c].front(), cells[c].back() });
        }
      }
    });
}

} // namespace

Midpoints makeMidpoints(const SimplexMesh& mesh, const EdgeTable& table, const EdgeMarks& marks)
{
  Midpoints result;
  result.firstVertex = static_cast<Index>(mesh.points.size());
  const std::size_t count = marks.size() - std::count(marks.begin(), marks.end(), 0);
  requireAtMost(mesh.points.size() + count, "points");
  reserveLong(result.edges, count);
  reserveLong(result.parentEdges, count);
  reserveLong(result.ofEdge, table.edges.size());
  result.ofEdge.assign(table.edges.size(), -1);
  for (std::size_t e = 0; e < table.edges.size(); ++e)
  {
    if (marks[e])
    {
      result.ofEdge[e] = result.nextVertex();
      result.edges.push_back(static_cast<Index>(e));
      result.parentEdges.push_back(table.edges[e]);
    }
  }
  return result;
}

Midpoints makeMidpoints(const SimplexMesh& mesh, const EdgeTable& table, const QuadTable& quads,
  const EdgeMarks& marks, bool uniform)
{
  Midpoints midpoints = makeMidpoints(mesh, table, marks);
  addQuadMidpoints(quads, midpoints);
  addHexahedronMidpoints(quads, midpoints);
  if (!uniform)
  {
    addApexes(mesh, table, quads, midpoints);
  }
  requireAtMost(mesh.points.size() + midpoints.parentEdges.size(), "points");
  return midpoints;
}

ChildRanges countMarkedChildren(
  const SimplexMesh& mesh, const EdgeTable& table, const QuadTable& quads, const EdgeMarks& marks)
{
  const EdgeOrder order(table);
  ChildRanges firsts;
  firsts[0] = evenChildren(mesh.vertices.size(), 1);
  ChildCount ofSegments(table.ofSegments.size());
  for (const auto& [edge] : table.ofSegments)
  {
    ofSegments.add(marks[edge] ? 2 : 1);
  }
  firsts[1] = ofSegments.finish();
  firsts[2] = countParts<3>(table.ofTriangles, order, marks);
  firsts[3] = countParts<4>(table.ofTetrahedra, order, marks);
  if (mesh.hasOtherThanSimplices())
  {
    countOthers(mesh, table, quads, marks, firsts);
  }
  return firsts;
}

ChildRanges countUniformChildren(const SimplexMesh& mesh)
{
  ChildRanges firsts{ evenChildren(mesh.vertices.size(), 1), evenChildren(mesh.segments.size(), 2),
    evenChildren(mesh.cellCount(2), 4), evenChildren(mesh.cellCount(3), 8) };
  if (!mesh.pyramids.empty())
  {
    ChildCount count(mesh.cellCount(3));
    visitShapes(mesh, 3,
      [&](auto shape, const auto& cells)
      {
        for (std::size_t c = 0; c < cells.size(); ++c)
        {
          count.add(std::is_same_v<decltype(shape), shapes::Pyramid> ? 10 : 8);
        }
      });
    firsts[3] = count.finish();
  }
  return firsts;
}

SplitMesh splitMarked(const SimplexMesh& mesh, const EdgeTable& table, const QuadTable& quads,
  const EdgeMarks& marks, const Midpoints& midpoints, const std::vector<GlobalId>& ids)
{
  SplitMesh result = withNewPoints(mesh, midpoints, ids);
  const EdgeOrder order(table);
  result.firstChildren = countMarkedChildren(mesh, table, quads, marks);
  result.mesh.vertices = mesh.vertices;
  splitSegments(mesh, table, midpoints, result);
  bisectAll<3, 3>(mesh.triangles, table.ofTriangles, order, midpoints, result.firstChildren[2],
    result.mesh.triangles);
  bisectAll<4, 6>(mesh.tetrahedra, table.ofTetrahedra, order, midpoints, result.firstChildren[3],
    result.mesh.tetrahedra);
  if (mesh.hasOtherThanSimplices())
  {
    splitOthers(mesh, table, quads, midpoints, result);
  }
  return result;
}

std::vector<Index> cellsCutBadly(
  const SimplexMesh& mesh, const EdgeTable& table, const QuadTable& quads, const EdgeMarks& marks)
{
  const Midpoints midpoints = makeMidpoints(mesh, table, quads, marks, false);
  std::vector<Point3> points = mesh.points;
  appendNewPoints(mesh, midpoints, points);
  const CellCutting cutting(mesh, table, quads, midpoints);
  SimplexMesh children;
  std::vector<Index> bad;
  cutOthers(mesh, cutting, midpoints, children,
    [&](Index cell)
    {
      const bool isCut = children.cellCount(3) > 1;
      if (isCut && !areValid(children, points) && isValid(mesh, cell))
      {
        bad.push_back(cell);
      }
      clearCells(children);
    });
  return bad;
}

std::vector<Index> pyramidsCutBadly(
  const SimplexMesh& mesh, const EdgeTable& table, const QuadTable& quads)
{
  std::vector<Index> bad;
  if (mesh.pyramids.empty())
  {
    return bad;
  }
  const EdgeMarks marks(table.edges.size(), 1);
  const Midpoints midpoints = makeMidpoints(mesh, table, quads, marks, true);
  std::vector<Point3> points = mesh.points;
  appendNewPoints(mesh, midpoints, points);
  SimplexMesh children;
  for (std::size_t c = 0; c < mesh.pyramids.size(); ++c)
  {
    splitPyramidUniformly(mesh.pyramids[c], midpointsOf(table.ofPyramids[c], midpoints.ofEdge),
      midpointsOf(quads.ofPyramids[c], midpoints.ofQuad)[0], children.pyramids,
      children.tetrahedra);
    const auto cell = static_cast<Index>(mesh.tetrahedra.size() + c);
    if (!areValid(children, points) && isValid(mesh, cell))
    {
      bad.push_back(cell);
    }
    clearCells(children);
  }
  return bad;
}

SplitMesh splitUniformly(const SimplexMesh& mesh, const EdgeTable& table, const QuadTable& quads,
  const Midpoints& midpoints, const std::vector<GlobalId>& ids)
{
  SplitMesh result = withNewPoints(mesh, midpoints, ids);
  result.firstChildren = countUniformChildren(mesh);
  result.mesh.vertices = mesh.vertices;
  splitSegments(mesh, table, midpoints, result);
  SimplexMesh& fine = result.mesh;
  const auto onEdges = [&](const auto& edges) { return midpointsOf(edges, midpoints.ofEdge); };
  const auto inQuads = [&](const auto& ofCell) { return midpointsOf(ofCell, midpoints.ofQuad); };
  reserveLong(fine.triangles, 4 * mesh.triangles.size());
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c)
  {
    splitTriangleUniformly(mesh.triangles[c], onEdges(table.ofTriangles[c]), fine.triangles);
  }
  reserveLong(fine.quadrilaterals, 4 * mesh.quadrilaterals.size());
  for (std::size_t c = 0; c < mesh.quadrilaterals.size(); ++c)
  {
    splitQuadrilateralUniformly(mesh.quadrilaterals[c], onEdges(table.ofQuadrilaterals[c]),
      inQuads(quads.ofQuadrilaterals[c])[0], fine.quadrilaterals);
  }
  reserveLong(fine.tetrahedra, 8 * mesh.tetrahedra.size() + 4 * mesh.pyramids.size());
  for (std::size_t c = 0; c < mesh.tetrahedra.size(); ++c)
  {
    splitTetrahedronUniformly(
      fine, mesh.tetrahedra[c], onEdges(table.ofTetrahedra[c]), fine.tetrahedra);
  }
  ChildNumbering numbering(fine, 3);
  reserveLong(fine.pyramids, 6 * mesh.pyramids.size());
  for (std::size_t c = 0; c < mesh.pyramids.size(); ++c)
  {
    splitPyramidUniformly(mesh.pyramids[c], onEdges(table.ofPyramids[c]),
      inQuads(quads.ofPyramids[c])[0], fine.pyramids, fine.tetrahedra);
    numbering.take();
  }
  reserveLong(fine.wedges, 8 * mesh.wedges.size());
  for (std::size_t c = 0; c < mesh.wedges.size(); ++c)
  {
    splitWedgeUniformly(
      mesh.wedges[c], onEdges(table.ofWedges[c]), inQuads(quads.ofWedges[c]), fine.wedges);
  }
  reserveLong(fine.hexahedra, 8 * mesh.hexahedra.size());
  for (std::size_t c = 0; c < mesh.hexahedra.size(); ++c)
  {
    splitHexahedronUniformly(mesh.hexahedra[c], onEdges(table.ofHexahedra[c]),
      inQuads(quads.ofHexahedra[c]), midpoints.ofHexahedron[c], fine.hexahedra);
  }
  if (!mesh.pyramids.empty())
  {
    numbering.take();
    result.children[3] = numbering.finish();
  }
  return result;
}

} // namespace cadrefine
