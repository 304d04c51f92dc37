#include "ClosestPointCase.h"

#include <cadrefine/cad/import/CADFile.h>
#include <cadrefine/cad/model/ModelDrawing.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <malloc.h>
#include <random>

namespace cadbenchmark
{
namespace
{

using namespace cadrefine;

double secondsSince(std::chrono::steady_clock::time_point start)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::size_t heapInUse()
{
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

/// A drawing of each face that is taken part of.
struct FaceDrawing
{
  int face;     // in the part
  int readFace; // in the whole model
  Tessellation drawing;
};

Point3 middleOf(const Tessellation& drawing)
{
  Point3 low = drawing.points.front();
  Point3 high = low;
  for (const Point3& p : drawing.points)
  {
    for (int k = 0; k < 3; ++k)
    {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  return 0.5 * (low + high);
}

bool contains(const std::optional<Region>& region, const Point3& p)
{
  bool inside = true;
  for (int k = 0; k < 3 && region; ++k)
  {
    inside = inside && p[k] >= region->low[k] && p[k] <= region->high[k];
  }
  return inside;
}

std::vector<FaceDrawing> drawFaces(const CADModel& model, const std::optional<Region>& region)
{
  constexpr double relativeDeflection = 1e-3;
  ModelDrawing whole = drawModel(model, relativeDeflection * model.size());
  std::vector<FaceDrawing> drawings;
  for (int f = 0; f < model.count(2); ++f)
  {
    Tessellation& drawing = whole.faces[f];
    if (!drawing.triangles.empty() && contains(region, middleOf(drawing)))
    {
      const int face = region ? static_cast<int>(drawings.size()) : f;
      drawings.push_back({ face, f, std::move(drawing) });
    }
  }
  return drawings;
}

/// The faces that are drawn, and their edges and vertices, numbered anew.
NurbsModel extract(const NurbsModel& whole, const std::vector<FaceDrawing>& drawings)
{
  NurbsModel part;
  std::vector<std::int32_t> edges(whole.edges.size(), -1);
  std::vector<std::int32_t> vertices(whole.vertices.size(), -1);
  const auto vertexOf = [&](std::int32_t old)
  {
    if (old >= 0 && vertices[old] < 0)
    {
      vertices[old] = static_cast<std::int32_t>(part.vertices.size());
      part.vertices.push_back({ whole.vertices[old].point, {}, whole.vertices[old].tolerance });
    }
    return old < 0 ? -1 : vertices[old];
  };
  for (const FaceDrawing& drawn : drawings)
  {
    NurbsFace face = whole.faces[drawn.readFace];
    for (std::int32_t& edge : face.edges)
    {
      if (edges[edge] < 0)
      {
        edges[edge] = static_cast<std::int32_t>(part.edges.size());
        part.edges.push_back(whole.edges[edge]);
        NurbsEdge& added = part.edges.back();
        added.faces.clear();
        added.firstVertex = vertexOf(added.firstVertex);
        added.lastVertex = vertexOf(added.lastVertex);
      }
      edge = edges[edge];
      part.edges[edge].faces.push_back(static_cast<std::int32_t>(part.faces.size()));
    }
    std::sort(face.edges.begin(), face.edges.end());
    for (TrimLoop& loop : face.loops)
    {
      for (BezierCurve2& curve : loop)
      {
        curve.edge = curve.edge < 0 ? -1 : edges[curve.edge];
      }
    }
    part.faces.push_back(std::move(face));
  }
  return part;
}

struct Triangle
{
  const FaceDrawing* drawn;
  std::array<Point3, 3> corners;
  double area() const
  {
    return 0.5 * norm(cross(corners[1] - corners[0], corners[2] - corners[0]));
  }
};

std::vector<Sample> scatter(
  const CADModel& model, const std::vector<FaceDrawing>& drawings, int points)
{
  std::vector<Triangle> triangles;
  std::vector<double> areas;
  for (const FaceDrawing& drawn : drawings)
  {
    const std::vector<Point3>& p = drawn.drawing.points;
    for (const auto& t : drawn.drawing.triangles)
    {
      triangles.push_back({ &drawn, { p[t[0]], p[t[1]], p[t[2]] } });
      areas.push_back(triangles.back().area());
    }
  }
  constexpr double relativeOffset = 1e-3;
  std::mt19937_64 generator(1);
  std::discrete_distribution<std::size_t> draw(areas.begin(), areas.end());
  std::uniform_real_distribution<double> part(0.0, 1.0);
  std::vector<Sample> samples(points);
  for (Sample& sample : samples)
  {
    const Triangle& t = triangles[draw(generator)];
    const double a = std::sqrt(part(generator));
    const double b = part(generator);
    const Point3 on =
      (1.0 - a) * t.corners[0] + a * (1.0 - b) * t.corners[1] + a * b * t.corners[2];
    const double offset = (2.0 * part(generator) - 1.0) * relativeOffset * model.size();
    const int face = t.drawn->readFace;
    const ClosestPoint foot = model.nearestOn({ 2, face }, on);
    sample = { foot.point + offset * model.normalNear(face, on), t.drawn->face, face };
  }
  return samples;
}

} // namespace

std::unique_ptr<const Case> loadCase(const CaseSource& source, int points)
{
  const auto path = std::find_if(source.paths.begin(), source.paths.end(),
    [](const std::string& p) { return std::filesystem::exists(p); });
  if (path == source.paths.end())
  {
    return nullptr;
  }
  auto loaded = std::make_unique<Case>();
  loaded->name = source.name;
  const auto readStart = std::chrono::steady_clock::now();
  loaded->model = readCADFile(*path);
  loaded->preparation.readSeconds = secondsSince(readStart);
  const std::vector<FaceDrawing> drawings = drawFaces(*loaded->model, source.region);
  loaded->nurbs =
    source.region ? extract(loaded->model->nurbs(), drawings) : loaded->model->nurbs();
  const std::size_t before = heapInUse();
  const auto buildStart = std::chrono::steady_clock::now();
  loaded->search = std::make_unique<const ClosestPointSearch>(loaded->nurbs);
  loaded->preparation.buildSeconds = secondsSince(buildStart);
  loaded->preparation.bytes = heapInUse() - before;
  for (const NurbsFace& face : loaded->nurbs.faces)
  {
    loaded->preparation.patches += face.patches.size();
  }
  loaded->scattered = scatter(*loaded->model, drawings, points);
  return loaded;
}

} // namespace cadbenchmark
