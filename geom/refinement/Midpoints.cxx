#include <cadrefine/refinement/Midpoints.h>

#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/base/LargeMemory.h>
#include <cadrefine/base/PieceLimit.h>
#include <cadrefine/mesh/CellJacobian.h>
#include <cadrefine/mesh/CellState.h>
#include <cadrefine/refinement/CellCutting.h>

namespace cadrefine
{
namespace
{

/// Calls use(corners) for the cells that have a new vertex in their middle, in their order.
template<class Use>
void forCornersOfCells(const Mesh& mesh, const Midpoints& midpoints, const Use& use)
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

/// The weights of a cell's corners in the vertex in its middle: all the same, but for a pyramid.
template<std::size_t Corners>
std::array<double, Corners> partsInMiddle(
  const std::array<Index, Corners>&, const std::vector<Point3>&)
{
  std::array<double, Corners> parts{};
  parts.fill(1.0 / static_cast<double>(Corners));
  return parts;
}

/// A pyramid's vertex is higher over its base than the mean of the corners, as a base that is not
/// plane rises: 3/8 of the way to the apex, where that of a pyramid of equal edges is as far from
/// all sides; or, from there, half of the rest of the way and again, until each corner of the base
/// is convex as seen from it, and so all that the base is cut into. The apex sees a valid pyramid's
/// base like that, so a vertex near enough to it does.
std::array<double, 5> partsInMiddle(
  const std::array<Index, 5>& pyramid, const std::vector<Point3>& points)
{
  constexpr double nearest = 1 - 1e-9;
  Pyramid below = cornersOf(pyramid, points);
  const Point3 apex = below[4];
  const Point3 base = 0.25 * (below[0] + below[1] + below[2] + below[3]);
  double part = 3.0 / 8;
  const auto seesBase = [&]
  {
    below[4] = (1 - part) * base + part * apex;
    return hasPositiveJacobian(below);
  };
  while (!seesBase() && part < nearest)
  {
    part = 0.5 * (1 + part);
  }
  const double ofBase = 0.25 * (1 - part);
  return { ofBase, ofBase, ofBase, ofBase, part };
}

void addQuadMidpoints(const QuadTable& quads, const EdgeMarks& marks, Midpoints& midpoints)
{
  midpoints.ofQuad.assign(quads.edges.size(), -1);
  midpoints.quads = quadsCutInFour(quads, marks);
  for (const Index q : midpoints.quads)
  {
    const auto onEdges = midpointsOf(quads.edges[q], midpoints.ofEdge);
    midpoints.ofQuad[q] = midpoints.nextVertex();
    midpoints.parentEdges.push_back({ onEdges[0], onEdges[2] });
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
  const Mesh& mesh, const EdgeTable& table, const QuadTable& quads, Midpoints& midpoints)
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

std::vector<Index> quadsCutInFour(const QuadTable& quads, const EdgeMarks& marks)
{
  return indicesWhere(quads.edges.size(),
    [&](std::size_t q)
    {
      return std::all_of(
        quads.edges[q].begin(), quads.edges[q].end(), [&](Index edge) { return marks[edge] != 0; });
    });
}

Midpoints makeMidpoints(const Mesh& mesh, const EdgeTable& table, const EdgeMarks& marks)
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

Midpoints makeMidpoints(const Mesh& mesh, const EdgeTable& table, const QuadTable& quads,
  const EdgeMarks& marks, bool uniform)
{
  Midpoints midpoints = makeMidpoints(mesh, table, marks);
  addQuadMidpoints(quads, marks, midpoints);
  addHexahedronMidpoints(quads, midpoints);
  if (!uniform)
  {
    addApexes(mesh, table, quads, midpoints);
  }
  requireAtMost(mesh.points.size() + midpoints.parentEdges.size(), "points");
  return midpoints;
}

WeightedRows rowsInMiddle(const Mesh& mesh, const Midpoints& midpoints)
{
  WeightedRows rows;
  Index vertex = midpoints.nextVertex() - static_cast<Index>(midpoints.cells.size());
  forCornersOfCells(mesh, midpoints,
    [&](const auto& corners)
    {
      const auto parts = partsInMiddle(corners, mesh.points);
      for (std::size_t k = 0; k < corners.size(); ++k)
      {
        rows.add(corners[k], parts[k]);
      }
      rows.endRow(vertex++);
    });
  return rows;
}

void appendNewPoints(const Mesh& mesh, const Midpoints& midpoints, std::vector<Point3>& points)
{
  const std::size_t halves = midpoints.parentEdges.size() - midpoints.cells.size();
  for (std::size_t n = 0; n < halves; ++n)
  {
    const auto& [a, b] = midpoints.parentEdges[n];
    points.push_back(0.5 * (points[a] + points[b]));
  }
  const WeightedRows rows = rowsInMiddle(mesh, midpoints);
  for (std::size_t r = 0; r < rows.size(); ++r)
  {
    Point3 middle{};
    for (Index k = rows.firsts[r]; k < rows.firsts[r + 1]; ++k)
    {
      middle = middle + rows.weights[k] * points[rows.sources[k]];
    }
    points.push_back(middle);
  }
}

} // namespace cadrefine
