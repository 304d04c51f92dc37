// Topology of the extracted model; the geometry is in FaceExtraction.cxx and EdgeExtraction.cxx.

#include <cadrefine/cad/extraction/NurbsExtraction.h>

#include <cadrefine/base/SortUniquely.h>
#include <cadrefine/nurbs/TrimMeasure.h>

#include <BRep_Tool.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <gp_Pnt.hxx>

namespace cadrefine
{
namespace
{

constexpr std::size_t entityGrain = 8; // about a millisecond

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

/// Links vertices and edges.
void linkVertices(const ShapeIndex& index, NurbsModel& model)
{
  for (std::size_t e = 0; e < model.edges.size(); ++e)
  {
    NurbsEdge& edge = model.edges[e];
    const TopoDS_Edge forward = TopoDS::Edge(index.edges()[e].Oriented(TopAbs_FORWARD));
    edge.firstVertex = index.vertex(TopExp::FirstVertex(forward));
    edge.lastVertex = index.vertex(TopExp::LastVertex(forward));
    for (const std::int32_t v : { edge.firstVertex, edge.lastVertex })
    {
      if (v >= 0)
      {
        model.vertices[v].edges.push_back(static_cast<std::int32_t>(e));
      }
    }
  }
  for (NurbsVertex& vertex : model.vertices)
  {
    sortUniquely(vertex.edges);
  }
}

/// Links edges and faces, and tells creases from smooth edges.
void linkFaces(const ShapeIndex& index, const ParallelFor& parallelFor, NurbsModel& model)
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
        model.faces[f].edges.push_back(e);
        model.edges[e].faces.push_back(static_cast<std::int32_t>(f));
      }
    }
    sortUniquely(model.faces[f].edges);
  }
  forEachIndex(parallelFor, model.edges.size(), entityGrain,
    [&](std::size_t e)
    {
      sortUniquely(model.edges[e].faces);
      model.edges[e].sharp = isSharp(uses[e]);
    });
}

} // namespace

NurbsModel extractNurbs(const ShapeIndex& index, const ParallelFor& parallelFor)
{
  NurbsModel model;
  extractGeometry(index, parallelFor, model);
  linkVertices(index, model);
  linkFaces(index, parallelFor, model);
  forEachIndex(parallelFor, model.faces.size(), entityGrain,
    [&](std::size_t f) { measureTrims(model, model.faces[f]); });
  return model;
}

} // namespace cadrefine
