// Free curves to a graph of edges with common vertices.
//
// 1. Take each edge's curve in space, cut to its range; drop those without length.
// 2. Gather their end points into clusters, nearest first come: a point joins the first cluster
//    whose seed lies within the tolerance.
// 3. Make one vertex for each cluster, in its middle, and every edge anew on its two vertices.

#include <cadrefine/cad/readers/healing/ShapePreparation.h>

#include <cadrefine/base/Vector3.h>

#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom_Curve.hxx>
#include <Precision.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>
#include <gp_Pnt.hxx>

#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

namespace cadrefine
{
namespace
{

struct FreeCurve
{
  TopoDS_Edge edge;
  Handle(Geom_Curve) curve;
  double first = 0;
  double last = 0;
  double tolerance = 0;
  double endTolerance = 0;
};

Point3 toPoint(const gp_Pnt& p)
{
  return { p.X(), p.Y(), p.Z() };
}

double chordLength(const FreeCurve& c)
{
  constexpr int pieces = 8;
  double length = 0;
  for (int i = 0; i < pieces; ++i)
  {
    const double step = (c.last - c.first) / pieces;
    length += c.curve->Value(c.first + i * step).Distance(c.curve->Value(c.first + (i + 1) * step));
  }
  return length;
}

/// Why the curve is left out; empty: it is not.
std::string faultOf(const FreeCurve& c)
{
  if (c.curve.IsNull())
  {
    return "has no curve in space";
  }
  if (Precision::IsInfinite(c.first) || Precision::IsInfinite(c.last))
  {
    return "has no end";
  }
  return chordLength(c) > Precision::Confusion() ? "" : "has no length";
}

/// The free curves among the edges; those that are left out are added to `lost`.
std::vector<FreeCurve> takeCurves(
  const TopoDS_Shape& edges, const AttributeMap& attributeMap, std::vector<UnreadEntity>& lost)
{
  std::vector<FreeCurve> curves;
  for (TopExp_Explorer explorer(edges, TopAbs_EDGE); explorer.More(); explorer.Next())
  {
    const TopoDS_Edge edge = TopoDS::Edge(explorer.Current());
    FreeCurve c;
    c.edge = edge;
    c.curve = BRep_Tool::Curve(edge, c.first, c.last);
    c.tolerance = BRep_Tool::Tolerance(edge);
    for (TopExp_Explorer end(edge, TopAbs_VERTEX); end.More(); end.Next())
    {
      const double tolerance = BRep_Tool::Tolerance(TopoDS::Vertex(end.Current()));
      c.endTolerance = std::max(c.endTolerance, tolerance);
    }
    const std::string fault = faultOf(c);
    if (fault.empty())
    {
      curves.push_back(c);
    }
    else
    {
      lost.push_back(attributeMap.lost(edge, fault));
    }
  }
  return curves;
}

double sizeOf(const std::vector<Point3>& points)
{
  Point3 low = points.front();
  Point3 high = points.front();
  for (const Point3& p : points)
  {
    for (int k = 0; k < 3; ++k)
    {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  return distance(low, high);
}

/// A thousandth of the shortest curve at most, so that no curve's own ends become one.
double joiningTolerance(const std::vector<FreeCurve>& curves, const std::vector<Point3>& ends)
{
  double shortest = chordLength(curves.front());
  double own = Precision::Confusion();
  for (const FreeCurve& c : curves)
  {
    shortest = std::min(shortest, chordLength(c));
    own = std::max({ own, c.tolerance, c.endTolerance });
  }
  return std::min(std::max(own, 1e-5 * sizeOf(ends)), std::max(own, 1e-3 * shortest));
}

/// For each point the number of its cluster; clusters are numbered by their first point.
std::vector<int> cluster(const std::vector<Point3>& points, double tolerance)
{
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
    [&](int a, int b) { return std::tie(points[a], a) < std::tie(points[b], b); });
  std::vector<int> representative(points.size(), -1);
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    const int seed = order[i];
    if (representative[seed] >= 0)
    {
      continue;
    }
    representative[seed] = seed;
    for (std::size_t j = i + 1;
         j < order.size() && points[order[j]][0] <= points[seed][0] + tolerance; ++j)
    {
      if (representative[order[j]] < 0 && distance(points[order[j]], points[seed]) <= tolerance)
      {
        representative[order[j]] = seed;
      }
    }
  }
  std::map<int, int> numbers;
  std::vector<int> clusters;
  clusters.reserve(representative.size());
  for (const int seed : representative)
  {
    clusters.push_back(numbers.emplace(seed, static_cast<int>(numbers.size())).first->second);
  }
  return clusters;
}

std::vector<TopoDS_Vertex> makeVertices(
  const std::vector<Point3>& points, const std::vector<int>& clusters)
{
  const int count = 1 + *std::max_element(clusters.begin(), clusters.end());
  std::vector<Point3> sums(count, Point3{});
  std::vector<int> sizes(count, 0);
  std::vector<double> spread(count, Precision::Confusion());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    sums[clusters[i]] = sums[clusters[i]] + points[i];
    ++sizes[clusters[i]];
  }
  for (int k = 0; k < count; ++k)
  {
    for (double& x : sums[k])
    {
      x /= sizes[k];
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    double& s = spread[clusters[i]];
    s = std::max(s, 1.001 * distance(points[i], sums[clusters[i]]));
  }
  std::vector<TopoDS_Vertex> vertices(count);
  for (int k = 0; k < count; ++k)
  {
    BRep_Builder().MakeVertex(vertices[k], gp_Pnt(sums[k][0], sums[k][1], sums[k][2]), spread[k]);
  }
  return vertices;
}

TopoDS_Edge makeEdge(
  const FreeCurve& c, const TopoDS_Vertex& firstVertex, const TopoDS_Vertex& lastVertex)
{
  const BRep_Builder builder;
  TopoDS_Edge edge;
  builder.MakeEdge(edge, c.curve, c.tolerance);
  builder.Add(edge, firstVertex.Oriented(TopAbs_FORWARD));
  builder.Add(edge, lastVertex.Oriented(TopAbs_REVERSED));
  builder.Range(edge, c.first, c.last);
  return edge;
}

} // namespace

JoinedCurves joinCurves(const TopoDS_Shape& edges, AttributeMap& attributeMap)
{
  const BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  buildCurvesInSpace(edges);
  JoinedCurves joined;
  joined.shape = compound;
  const std::vector<FreeCurve> curves = takeCurves(edges, attributeMap, joined.lost);
  if (curves.empty())
  {
    return joined;
  }
  std::vector<Point3> ends;
  for (const FreeCurve& c : curves)
  {
    ends.push_back(toPoint(c.curve->Value(c.first)));
    ends.push_back(toPoint(c.curve->Value(c.last)));
  }
  const std::vector<int> clusters = cluster(ends, joiningTolerance(curves, ends));
  const std::vector<TopoDS_Vertex> vertices = makeVertices(ends, clusters);
  for (std::size_t i = 0; i < curves.size(); ++i)
  {
    const TopoDS_Edge edge =
      makeEdge(curves[i], vertices[clusters[2 * i]], vertices[clusters[2 * i + 1]]);
    attributeMap.follow(curves[i].edge, edge);
    builder.Add(joined.shape, edge);
  }
  return joined;
}

} // namespace cadrefine
