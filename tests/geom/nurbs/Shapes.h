// Exact models for the tests, built by hand from rational Bezier patches.
#pragma once

#include <cadrefine/nurbs/NurbsModel.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace cadrefine::shapes
{

/// Quarter of the unit circle number `k`, counted from the x axis, as (x, y, weight).
inline std::vector<ControlPoint2> quarterArc(int k)
{
  const double h = std::sqrt(0.5);
  const double x[5] = { 1, 0, -1, 0, 1 };
  const double y[5] = { 0, 1, 0, -1, 0 };
  const int a = k % 4;
  return { { x[a], y[a], 1.0 }, { h * (x[a] + x[a + 1]), h * (y[a] + y[a + 1]), h },
    { x[a + 1], y[a + 1], 1.0 } };
}

/// Face swept by a profile in the (radius, z) half plane about the z axis: u in [0, 4] counts
/// quarter turns, v in [0, number of profile curves].
inline NurbsFace revolve(const std::vector<BezierCurve2>& profile)
{
  NurbsFace face;
  face.patchesU = 4;
  face.patchesV = static_cast<int>(profile.size());
  for (int i = 0; i < 4; ++i)
  {
    for (int j = 0; j < face.patchesV; ++j)
    {
      const std::vector<ControlPoint2>& section = profile[j].points;
      BezierPatch patch = { 2, static_cast<int>(section.size()) - 1, 1.0 * i, i + 1.0, 1.0 * j,
        j + 1.0, {} };
      for (const ControlPoint2& c : quarterArc(i))
      {
        for (const ControlPoint2& p : section)
        {
          patch.points.push_back({ c[0] * p[0], c[1] * p[0], c[2] * p[1], c[2] * p[2] });
        }
      }
      face.patches.push_back(patch);
    }
  }
  return face;
}

/// Arc number k of a circle in the (radius, z) half plane.
inline BezierCurve2 profileArc(int k, double centre, double radius)
{
  BezierCurve2 curve{ quarterArc(k) };
  for (ControlPoint2& p : curve.points)
  {
    p[0] = centre * p[2] + radius * p[0];
    p[1] = radius * p[1];
  }
  return curve;
}

inline NurbsFace sphere(double radius)
{
  return revolve({ profileArc(3, 0.0, radius), profileArc(0, 0.0, radius) });
}

inline NurbsFace torus(double major, double minor)
{
  return revolve({ profileArc(0, major, minor), profileArc(1, major, minor),
    profileArc(2, major, minor), profileArc(3, major, minor) });
}

inline NurbsFace cylinder(double radius, double z0, double z1)
{
  return revolve({ BezierCurve2{ { { radius, z0, 1.0 }, { radius, z1, 1.0 } } } });
}

inline NurbsModel modelOf(const NurbsFace& face)
{
  NurbsModel model;
  model.faces.push_back(face);
  return model;
}

/// Circle about (0, 0, z) in a plane of constant z; t in [0, 4].
inline NurbsEdge circle(double radius, double z)
{
  NurbsEdge edge;
  for (int k = 0; k < 4; ++k)
  {
    BezierCurve segment = { 1.0 * k, k + 1.0, {} };
    for (const ControlPoint2& p : quarterArc(k))
    {
      segment.points.push_back({ radius * p[0], radius * p[1], z * p[2], p[2] });
    }
    edge.segments.push_back(segment);
  }
  return edge;
}

/// Straight edge between two vertices of the model, which it is added to; t in [0, 1].
inline int addLine(NurbsModel& model, int first, int last)
{
  const Point3 a = model.vertices[first].point;
  const Point3 b = model.vertices[last].point;
  NurbsEdge edge;
  edge.segments = { { 0.0, 1.0, { { a[0], a[1], a[2], 1.0 }, { b[0], b[1], b[2], 1.0 } } } };
  edge.firstVertex = first;
  edge.lastVertex = last;
  const int index = static_cast<int>(model.edges.size());
  model.edges.push_back(edge);
  model.vertices[first].edges.push_back(index);
  model.vertices[last].edges.push_back(index);
  return index;
}

inline TrimLoop circleLoop(double u, double v, double radius)
{
  TrimLoop loop;
  for (int k = 0; k < 4; ++k)
  {
    BezierCurve2 arc{ quarterArc(k) };
    for (ControlPoint2& p : arc.points)
    {
      p = { u * p[2] + radius * p[0], v * p[2] + radius * p[1], p[2] };
    }
    loop.push_back(arc);
  }
  return loop;
}

inline TrimLoop polygonLoop(const std::vector<Point2>& corners)
{
  TrimLoop loop;
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    const Point2& a = corners[i];
    const Point2& b = corners[(i + 1) % corners.size()];
    loop.push_back({ { { a[0], a[1], 1.0 }, { b[0], b[1], 1.0 } } });
  }
  return loop;
}

/// The square [-2, 2]^2 at z = 0, parameters x and y, with a round hole of radius 1: edges 0 to 3
/// straight from vertex i to i + 1, edge 4 the hole.
inline NurbsModel plateWithHole()
{
  NurbsModel model;
  NurbsFace face;
  face.patchesU = face.patchesV = 1;
  face.patches = { { 1, 1, -2, 2, -2, 2,
    { { -2, -2, 0, 1 }, { -2, 2, 0, 1 }, { 2, -2, 0, 1 }, { 2, 2, 0, 1 } } } };
  const std::vector<Point2> corners = { { -2, -2 }, { 2, -2 }, { 2, 2 }, { -2, 2 } };
  face.loops = { polygonLoop(corners), circleLoop(0, 0, 1) };
  for (const Point2& c : corners)
  {
    model.vertices.push_back({ { c[0], c[1], 0.0 }, {}, 0.0 });
  }
  for (int i = 0; i < 4; ++i)
  {
    addLine(model, i, (i + 1) % 4);
  }
  model.edges.push_back(circle(1, 0));
  face.edges = { 0, 1, 2, 3, 4 };
  for (NurbsEdge& edge : model.edges)
  {
    edge.faces = { 0 };
  }
  model.faces.push_back(face);
  return model;
}

/// Numbers in [-1, 1], the same on every machine.
class Random
{
public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double operator()()
  {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state_ >> 11) / 4503599627370496.0 - 1.0;
  }
  Point3 point(double scale)
  {
    const double x = (*this)();
    const double y = (*this)();
    const double z = (*this)();
    return { scale * x, scale * y, scale * z };
  }

private:
  std::uint64_t state_;
};

/// A continuous bumpy face over [0, n]^2 of n x n rational bicubic patches.
inline NurbsFace bumpyFace(int n, double height, std::uint64_t seed)
{
  Random random(seed);
  const int side = 3 * n + 1;
  std::vector<ControlPoint> net;
  for (int i = 0; i < side * side; ++i)
  {
    const double w = 1.0 + 0.3 * random();
    const int row = i / side;
    const double x = (row + 0.3 * random()) / 3.0;
    const double y = (i - row * side + 0.3 * random()) / 3.0;
    net.push_back({ w * x, w * y, w * height * random(), w });
  }
  NurbsFace face;
  face.patchesU = face.patchesV = n;
  for (int i = 0; i < n; ++i)
  {
    for (int j = 0; j < n; ++j)
    {
      BezierPatch patch = { 3, 3, 1.0 * i, i + 1.0, 1.0 * j, j + 1.0, {} };
      for (int k = 0; k < 16; ++k)
      {
        patch.points.push_back(net[(3 * i + k / 4) * side + 3 * j + k % 4]);
      }
      face.patches.push_back(patch);
    }
  }
  return face;
}

} // namespace cadrefine::shapes
