// 1. Open edges: those that bound one face, once.
// 2. Edge a runs beside edge b of another face if its points at 1/6, ..., 5/6 of its parameter
//    range are all within the limit of b, and b is not shorter. At an angle to each other, edges
//    part by more than a quarter of a's length, which is the limit.
// 3. The width is the largest of these distances.

#include <cadrefine/cad/readers/healing/GapSearch.h>

#include <cadrefine/cad/import/IsolatedRun.h>

#include <BRepAdaptor_Curve.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <TopExp_Explorer.hxx>

#include <algorithm>

namespace cadrefine
{
namespace
{

struct OpenEdge
{
  int index = 0;
  int face = 0;
  TopoDS_Edge edge;
  double length = 0;
  Bnd_Box box;
};

std::vector<OpenEdge> openEdges(const ShapeIndex& index)
{
  std::vector<int> uses(index.edges().size(), 0);
  std::vector<int> faces(index.edges().size(), -1);
  for (std::size_t f = 0; f < index.faces().size(); ++f)
  {
    for (TopExp_Explorer edge(index.faces()[f], TopAbs_EDGE); edge.More(); edge.Next())
    {
      const int e = index.edge(edge.Current());
      if (e >= 0)
      {
        ++uses[e];
        faces[e] = static_cast<int>(f);
      }
    }
  }
  std::vector<OpenEdge> open;
  for (std::size_t e = 0; e < uses.size(); ++e)
  {
    if (uses[e] == 1)
    {
      OpenEdge edge{ static_cast<int>(e), faces[e], index.edges()[e], 0, {} };
      edge.length = GCPnts_AbscissaPoint::Length(BRepAdaptor_Curve(edge.edge));
      BRepBndLib::Add(edge.edge, edge.box, false);
      open.push_back(edge);
    }
  }
  return open;
}

/// The gap between `a` and the longer edge `b`; of width 0 where they do not run together. The
/// middle of `a` comes first, since that is where edges that only meet are apart.
Gap measure(const OpenEdge& a, const OpenEdge& b, double limit)
{
  const BRepAdaptor_Curve curve(a.edge);
  Gap gap;
  gap.edges = { std::min(a.index, b.index), std::max(a.index, b.index) };
  for (const int sixth : { 3, 1, 2, 4, 5 })
  {
    const double part = sixth / 6.0;
    const gp_Pnt p =
      curve.Value((1 - part) * curve.FirstParameter() + part * curve.LastParameter());
    const BRepExtrema_DistShapeShape nearest(BRepBuilderAPI_MakeVertex(p).Vertex(), b.edge);
    if (!nearest.IsDone() || nearest.Value() > limit)
    {
      return {};
    }
    if (nearest.Value() > gap.width)
    {
      gap.width = nearest.Value();
      gap.point = { p.X(), p.Y(), p.Z() };
    }
  }
  return gap;
}

} // namespace

std::vector<Gap> findGaps(const ShapeIndex& index, double modelSize)
{
  constexpr double widest = 0.01;
  constexpr double longest = 0.25;
  std::vector<OpenEdge> edges = openEdges(index);
  std::stable_sort(edges.begin(), edges.end(),
    [](const OpenEdge& a, const OpenEdge& b) { return a.length < b.length; });
  std::vector<Gap> gaps;
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    const OpenEdge& a = edges[i];
    const double limit = std::min(widest * modelSize, longest * a.length);
    Bnd_Box near = a.box;
    near.Enlarge(limit);
    noteProgress();
    for (std::size_t j = i + 1; j < edges.size(); ++j)
    {
      const OpenEdge& b = edges[j];
      if (a.face != b.face && !near.IsOut(b.box))
      {
        const Gap gap = measure(a, b, limit);
        if (gap.width > 0)
        {
          gaps.push_back(gap);
        }
      }
    }
  }
  std::sort(gaps.begin(), gaps.end(),
    [](const Gap& a, const Gap& b)
    { return a.width != b.width ? a.width > b.width : a.edges < b.edges; });
  return gaps;
}

} // namespace cadrefine
