#include <cadrefine/refinement/Split.h>

#include <cadrefine/base/LargeMemory.h>
#include <cadrefine/base/PieceLimit.h>
#include <cadrefine/mesh/CellState.h>
#include <cadrefine/refinement/Bisection.h>
#include <cadrefine/refinement/CellCutting.h>
#include <cadrefine/refinement/UniformCutting.h>

#include <algorithm>
#include <numeric>
#include <type_traits>
#include <utility>

namespace cadrefine
{
namespace
{

/// The split mesh with its points but without cells.
SplitMesh withNewPoints(
  const Mesh& mesh, const Midpoints& midpoints, const std::vector<GlobalId>& ids)
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

/// Counts the children of one cell after the other.
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

  /// Returns where the children of each cell begin. Throws Error where they are too many for one
  /// rank.
  std::vector<Index> finish()
  {
    requireAtMost(total_, "cells");
    return std::move(firsts_);
  }

private:
  std::vector<Index> firsts_;
  std::size_t total_ = 0;
};

/// Where the children of each cell begin if all cells have equally many. Throws as
/// ChildCount::finish.
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
  const Mesh& mesh, const EdgeTable& table, const Midpoints& midpoints, SplitMesh& result)
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
void bisectAll(const Cells<Corners>& cells, const std::vector<std::array<Index, Edges>>& edges,
  const EdgeOrder& order, const Midpoints& midpoints, const std::vector<Index>& firstChildren,
  Cells<Corners>& children)
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

/// Numbers the children of cells of one dimension, which are appended to the cells of several
/// shapes.
class ChildNumbering
{
public:
  ChildNumbering(const Mesh& children, int dimension) : children_(children), dimension_(dimension)
  {
  }

  /// Takes the children that were appended since the last time: those of one cell, or of several in
  /// turn that have children of the first shape alone. Returns how many they are.
  std::size_t take()
  {
    const std::size_t begun = taken_.size();
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
    return taken_.size() - begun;
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
  const Mesh& children_;
  int dimension_;
  std::array<std::size_t, 4> counts_{};
  std::vector<std::pair<std::size_t, std::size_t>> taken_; ///< Shape, and place among its cells.
};

/// Cuts all cells of volume that are not simplices; use(cell) after each, by its number.
template<class Use>
void cutOthers(const Mesh& mesh, const CellCutting& cutting, const Midpoints& midpoints,
  Mesh& children, const Use& use)
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
void cutQuadrilaterals(const Mesh& mesh, const CellCutting& cutting, Mesh& children, const Use& use)
{
  for (Index c = 0; c < static_cast<Index>(mesh.quadrilaterals.size()); ++c)
  {
    cutting.cut(shapes::Quadrilateral{}, c, children);
    use();
  }
}

void clearCells(Mesh& mesh)
{
  visitShapes(mesh, [](auto, auto& cells) { cells.clear(); });
}

/// Appends where the children of the next cell end.
void appendChildren(std::size_t children, std::vector<Index>& firsts)
{
  const std::size_t total = firsts.back() + children;
  requireAtMost(total, "cells");
  firsts.push_back(static_cast<Index>(total));
}

/// The children of tetrahedra, triangles, segments and vertices that splitMarked makes.
ChildRanges countPartsOfSimplices(const Mesh& mesh, const EdgeTable& table, const EdgeMarks& marks)
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
  return firsts;
}

/// Cuts the cells that are not simplices, and appends where the children of each end.
void splitOthers(const Mesh& mesh, const EdgeTable& table, const QuadTable& quads,
  const Midpoints& midpoints, SplitMesh& result)
{
  const CellCutting cutting(mesh, table, quads, midpoints);
  ChildNumbering flat(result.mesh, 2);
  flat.take();
  cutQuadrilaterals(
    mesh, cutting, result.mesh, [&] { appendChildren(flat.take(), result.firstChildren[2]); });
  result.children[2] = flat.finish();
  ChildNumbering ofVolume(result.mesh, 3);
  ofVolume.take();
  cutOthers(mesh, cutting, midpoints, result.mesh,
    [&](Index) { appendChildren(ofVolume.take(), result.firstChildren[3]); });
  result.children[3] = ofVolume.finish();
  result.ofVertices = rowsInMiddle(mesh, midpoints);
}

bool areValid(const Mesh& cells, const std::vector<Point3>& points)
{
  bool valid = true;
  visitOwnShapes(cells,
    [&](auto shape, const auto& all)
    {
      valid = valid && std::all_of(all.begin(), all.end(),
                         [&](const auto& cell)
                         { return stateAt(shape, cornersOf(cell, points), {}, 0).valid; });
    });
  return valid;
}

/// Whether the cell of volume of this number is valid.
bool isValid(const Mesh& mesh, Index cell)
{
  bool valid = false;
  visitOwnCell(mesh, cell,
    [&](auto shape, const auto& corners)
    { valid = stateAt(shape, cornersOf(corners, mesh.points), {}, 0).valid; });
  return valid;
}

} // namespace

ChildRanges countMarkedChildren(
  const Mesh& mesh, const EdgeTable& table, const QuadTable& quads, const EdgeMarks& marks)
{
  ChildRanges firsts = countPartsOfSimplices(mesh, table, marks);
  if (mesh.hasNonSimplices())
  {
    const Midpoints midpoints = makeMidpoints(mesh, table, quads, marks, false);
    const CellCutting cutting(mesh, table, quads, midpoints);
    Mesh children;
    const auto count = [&](int dimension)
    {
      appendChildren(children.cellCount(dimension), firsts[dimension]);
      clearCells(children);
    };
    cutQuadrilaterals(mesh, cutting, children, [&] { count(2); });
    cutOthers(mesh, cutting, midpoints, children, [&](Index) { count(3); });
  }
  return firsts;
}

ChildRanges countUniformChildren(const Mesh& mesh)
{
  ChildRanges firsts{ evenChildren(mesh.vertices.size(), 1), evenChildren(mesh.segments.size(), 2),
    evenChildren(mesh.cellCount(2), 4), evenChildren(mesh.cellCount(3), 8) };
  if (!mesh.pyramids.empty())
  {
    ChildCount count(mesh.cellCount(3));
    visitShapes(mesh, 3,
      [&](auto shape, const auto& cells)
      {
        for (const auto& cell : cells)
        {
          if constexpr (std::is_same_v<decltype(shape), shapes::Pyramid>)
          {
            count.add(partingDiagonal(mesh, cell) ? childrenOfPartedPyramid : childrenOfPyramid);
          }
          else
          {
            count.add(8);
          }
        }
      });
    firsts[3] = count.finish();
  }
  return firsts;
}

SplitMesh splitMarked(const Mesh& mesh, const EdgeTable& table, const QuadTable& quads,
  const EdgeMarks& marks, const Midpoints& midpoints, const std::vector<GlobalId>& ids)
{
  SplitMesh result = withNewPoints(mesh, midpoints, ids);
  const EdgeOrder order(table);
  result.firstChildren = countPartsOfSimplices(mesh, table, marks);
  result.mesh.vertices = mesh.vertices;
  splitSegments(mesh, table, midpoints, result);
  bisectAll<3, 3>(mesh.triangles, table.ofTriangles, order, midpoints, result.firstChildren[2],
    result.mesh.triangles);
  bisectAll<4, 6>(mesh.tetrahedra, table.ofTetrahedra, order, midpoints, result.firstChildren[3],
    result.mesh.tetrahedra);
  if (mesh.hasNonSimplices())
  {
    splitOthers(mesh, table, quads, midpoints, result);
  }
  return result;
}

std::vector<Index> cellsCutBadly(const Mesh& mesh, const EdgeTable& table, const QuadTable& quads,
  const EdgeMarks& marks, bool uniform)
{
  const Midpoints midpoints = makeMidpoints(mesh, table, quads, marks, uniform);
  std::vector<Point3> points = mesh.points;
  appendNewPoints(mesh, midpoints, points);
  Mesh children;
  std::vector<Index> bad;
  const auto look = [&](Index cell)
  {
    const bool isCut = children.cellCount(3) > 1;
    if (isCut && !areValid(children, points) && isValid(mesh, cell))
    {
      bad.push_back(cell);
    }
    clearCells(children);
  };
  if (uniform)
  {
    for (std::size_t c = 0; c < mesh.pyramids.size(); ++c)
    {
      splitPyramidUniformly(mesh, mesh.pyramids[c],
        midpointsOf(table.ofPyramids[c], midpoints.ofEdge),
        midpointsOf(quads.ofPyramids[c], midpoints.ofQuad)[0], children.pyramids,
        children.tetrahedra);
      look(static_cast<Index>(mesh.tetrahedra.size() + c));
    }
  }
  else
  {
    cutOthers(mesh, CellCutting(mesh, table, quads, midpoints), midpoints, children, look);
  }
  return bad;
}

SplitMesh splitUniformly(const Mesh& mesh, const EdgeTable& table, const QuadTable& quads,
  const Midpoints& midpoints, const std::vector<GlobalId>& ids)
{
  SplitMesh result = withNewPoints(mesh, midpoints, ids);
  result.firstChildren = countUniformChildren(mesh);
  result.mesh.vertices = mesh.vertices;
  splitSegments(mesh, table, midpoints, result);
  Mesh& fine = result.mesh;
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
    splitPyramidUniformly(mesh, mesh.pyramids[c], onEdges(table.ofPyramids[c]),
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
