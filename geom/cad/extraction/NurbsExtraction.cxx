// Topology of the extracted model; the geometry is in FaceExtraction.cxx and EdgeExtraction.cxx.

#include <cadrefine/cad/extraction/NurbsExtraction.h>

#include <cadrefine/base/BoundingBox.h>
#include <cadrefine/base/SortUniquely.h>
#include <cadrefine/nurbs/TrimMeasure.h>

#include <BRep_Tool.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <gp_Pnt.hxx>

#include <algorithm>
#include <map>
#include <utility>

namespace cadrefine
{
namespace
{

constexpr std::size_t entityGrain = 8; // about a millisecond
/// What is nearer to each other than this part of the box of all vertices has no nearest point of
/// its own.
constexpr double coincident = 1e-9;

NurbsVertex extractVertex(const TopoDS_Vertex& vertex)
{
  const gp_Pnt p = BRep_Tool::Pnt(vertex);
  NurbsVertex result;
  result.point = { p.X(), p.Y(), p.Z() };
  result.tolerance = BRep_Tool::Tolerance(vertex);
  return result;
}

void extractGeometry(const ShapeIndex& index, const ParallelFor& parallelFor, NurbsModel& model)
{
  model.faces.resize(index.faces().size());
  forEachIndex(parallelFor, model.faces.size(), entityGrain,
    [&](std::size_t f) { model.faces[f] = extractFace(index.faces()[f], &index); });
  model.edges.resize(index.edges().size());
  forEachIndex(parallelFor, model.edges.size(), entityGrain,
    [&](std::size_t e) { model.edges[e] = extractEdge(index.edges()[e]); });
  for (const TopoDS_Vertex& vertex : index.vertices())
  {
    model.vertices.push_back(extractVertex(index.vertices()[index.vertex(vertex)]));
  }
}

/// For each edge the first one that runs along all of it: where bodies touch, files hold edges
/// twice.
std::vector<std::int32_t> findFirstAlong(const NurbsModel& model)
{
  BoundingBox box;
  for (const NurbsVertex& vertex : model.vertices)
  {
    box.include(vertex.point);
  }
  const double limit = coincident * box.diagonal();
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::int32_t>> ofEnds;
  std::vector<std::int32_t> firsts;
  for (std::size_t e = 0; e < model.edges.size(); ++e)
  {
    const NurbsEdge& edge = model.edges[e];
    auto& others = ofEnds[std::minmax({ edge.firstVertex, edge.lastVertex })];
    const auto found = std::find_if(others.begin(), others.end(),
      [&](std::int32_t other) { return farthestFrom(model.edges[other], edge) <= limit; });
    const auto index = static_cast<std::int32_t>(e);
    firsts.push_back(found == others.end() ? index : *found);
    if (found == others.end() && edge.firstVertex >= 0)
    {
      others.push_back(index);
    }
  }
  return firsts;
}

/// Links vertices and edges, and gives edges that coincide one geometry. Returns the first one of
/// these for each; the others bound nothing.
std::vector<std::int32_t> linkVertices(const ShapeIndex& index, NurbsModel& model)
{
  for (std::size_t e = 0; e < model.edges.size(); ++e)
  {
    const TopoDS_Edge forward = TopoDS::Edge(index.edges()[e].Oriented(TopAbs_FORWARD));
    model.edges[e].firstVertex = index.vertex(TopExp::FirstVertex(forward));
    model.edges[e].lastVertex = index.vertex(TopExp::LastVertex(forward));
  }
  auto firsts = findFirstAlong(model);
  for (std::size_t e = 0; e < model.edges.size(); ++e)
  {
    const auto first = static_cast<std::size_t>(firsts[e]);
    if (first != e)
    {
      model.edges[e] = model.edges[first];
    }
    for (const std::int32_t v : { model.edges[first].firstVertex, model.edges[first].lastVertex })
    {
      if (v >= 0)
      {
        model.vertices[v].edges.push_back(firsts[e]);
      }
    }
  }
  for (NurbsVertex& vertex : model.vertices)
  {
    sortUniquely(vertex.edges);
  }
  return firsts;
}

/// Links edges and faces, and tells creases from smooth edges.
void linkFaces(const ShapeIndex& index, const std::vector<std::int32_t>& firstEdges,
  const ParallelFor& parallelFor, NurbsModel& model)
{
  std::vector<std::vector<EdgeUse>> uses(model.edges.size());
  for (std::size_t f = 0; f < model.faces.size(); ++f)
  {
    const TopoDS_Face& face = index.faces()[f];
    for (TopExp_Explorer explorer(face, TopAbs_EDGE); explorer.More(); explorer.Next())
    {
      const int e = index.edge(explorer.Current());
      if (e >= 0)
      {
        uses[e].push_back({ TopoDS::Edge(explorer.Current()), face });
        model.faces[f].edges.push_back(firstEdges[e]);
        model.edges[firstEdges[e]].faces.push_back(static_cast<std::int32_t>(f));
      }
    }
    sortUniquely(model.faces[f].edges);
    for (TrimLoop& loop : model.faces[f].loops)
    {
      for (BezierCurve2& curve : loop)
      {
        curve.edge = curve.edge < 0 ? -1 : firstEdges[curve.edge];
      }
    }
  }
  std::vector<unsigned char> sharp(model.edges.size());
  forEachIndex(parallelFor, sharp.size(), entityGrain,
    [&](std::size_t e)
    {
      sortUniquely(model.edges[e].faces);
      sharp[e] = uses[e].empty() ? model.faces.empty() : isSharp(uses[e]);
    });
  for (std::size_t e = 0; e < sharp.size(); ++e)
  {
    model.edges[e].sharp = false;
    NurbsEdge& first = model.edges[firstEdges[e]];
    first.sharp = first.sharp || sharp[e];
  }
}

} // namespace

NurbsModel extractNurbs(const ShapeIndex& index, const ParallelFor& parallelFor)
{
  NurbsModel model;
  extractGeometry(index, parallelFor, model);
  const auto firstEdges = linkVertices(index, model);
  linkFaces(index, firstEdges, parallelFor, model);
  forEachIndex(parallelFor, model.faces.size(), entityGrain,
    [&](std::size_t f) { measureTrims(model, model.faces[f]); });
  return model;
}

} // namespace cadrefine
