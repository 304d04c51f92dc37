// Formulas of the parts. x points aft from the nose, y to starboard, z up; lengths in metres.

#include "aeroplane_parts.h"

#include "aeroplane_splines.h"

#include <BRepBuilderAPI_Transform.hxx>
#include <gp_Ax2.hxx>
#include <gp_Trsf.hxx>

#include <cmath>

namespace aeroplane
{
namespace
{

constexpr double pi = 3.14159265358979323846;

gp_XYZ point(double x, double y, double z)
{
  return gp_XYZ(x, y, z) * metre;
}

/// Strides of `cut` that leave few faces, or all.
int stride(Layout layout, int plain)
{
  return layout == Layout::Plain ? plain : 1;
}

TopoDS_Shape solidOf(
  const Handle(Geom_BSplineSurface) & surface, Layout layout, int plainU, int plainV)
{
  Patches patches;
  cut(surface, stride(layout, plainU), stride(layout, plainV), patches);
  return aeroplane::solidOf(patches);
}

TopoDS_Shape mirrored(const TopoDS_Shape& shape)
{
  gp_Trsf mirror;
  mirror.SetMirror(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 1, 0)));
  constexpr bool copy = true;
  return BRepBuilderAPI_Transform(shape, mirror, copy).Shape();
}

Stations radians(Stations degrees)
{
  for (double& angle : degrees)
  {
    angle *= pi / 180;
  }
  return degrees;
}

// The fuselage: half an ellipse, a cylinder and a tapering tail with a round end, along a parameter
// u in which x grows at the same speed where they meet. Sections are upright ellipses.
namespace fuselage
{
constexpr double noseLength = 0.4, tailStart = 1.2, tailLength = 0.8;
constexpr double halfWidth = 0.12, heightToWidth = 1.1;
constexpr double droop = 0.03;     ///< Of the nose.
constexpr double upsweep = 0.06;   ///< Of the tail.
constexpr double coneShare = 0.6;  ///< Of the tail, beside the ellipse that makes its end round.
constexpr double noseEnd = pi / 2; ///< In u.
constexpr double tailBegin = noseEnd + (tailStart - noseLength) / noseLength;

double parameterAt(double x)
{
  return x < noseLength  ? std::acos(1 - x / noseLength)
         : x < tailStart ? noseEnd + (x - noseLength) / noseLength
                         : tailBegin + tailLength / noseLength *
                                         std::asin(std::min(1.0, (x - tailStart) / tailLength));
}

gp_XYZ surface(double u, double angle)
{
  double x = noseLength + (u - noseEnd) * noseLength, radius = 1, centre = 0;
  if (u < noseEnd)
  {
    x = noseLength * (1 - std::cos(u));
    radius = std::sin(u);
    centre = -droop * std::cos(u) * std::cos(u);
  }
  else if (u > tailBegin)
  {
    const double turned = (u - tailBegin) * noseLength / tailLength;
    const double c = std::cos(turned), s = std::sin(turned);
    x = tailStart + tailLength * s;
    radius = (1 - coneShare) * c + coneShare * c * c;
    centre = upsweep * s * s;
  }
  radius *= halfWidth;
  return point(x, radius * std::cos(angle), centre + heightToWidth * radius * std::sin(angle));
}

TopoDS_Shape solid(Layout layout)
{
  Stations frames{ 0, 0.03, 0.08, 0.145, 0.21, 0.28, 0.34, 0.4, 0.47, 0.54, 0.61, 0.68, 0.75, 0.82,
    0.89, 0.95, 1.01, 1.07, 1.15, 1.24, 1.31, 1.38, 1.43, 1.49, 1.55, 1.61, 1.67, 1.74, 1.8, 1.86,
    1.92, 1.97, 2 };
  for (double& frame : frames)
  {
    frame = parameterAt(frame);
  }
  const Stations stringers =
    radians({ -90, -62, -42, -21, 0, 28, 58, 90, 122, 152, 180, 201, 222, 242, 270 });
  return solidOf(interpolate(surface, frames, stringers), layout, 8, 7);
}
} // namespace fuselage

TopoDS_Shape canopy(Layout layout)
{
  const auto surface = [](double u, double angle)
  {
    const double radius = std::sin(u);
    return point(0.218 - 0.13 * std::cos(u), 0.066 * radius * std::cos(angle),
      0.05 + 0.1 * radius * std::sin(angle));
  };
  const Stations hoops = radians({ 0, 42, 72, 102, 134, 180 });
  const Stations sills = radians({ -90, -20, 50, 90, 130, 200, 270 });
  return solidOf(interpolate(surface, hoops, sills), layout, 5, 3);
}

/// Half thickness of a NACA four-digit section of unit chord and thickness, closed at the trailing
/// edge, at x = root * root.
double halfThickness(double root)
{
  const double x = root * root;
  return 5 * (0.2969 * root + x * (-0.126 + x * (-0.3516 + x * (0.2843 - 0.1036 * x))));
}

/// Camber line of a NACA four-digit section with its crest at 0.4 of the unit chord.
double camber(double x, double crest)
{
  constexpr double at = 0.4;
  const double length = x < at ? at : 1 - at;
  const double from = (x - at) / length;
  return crest * (1 - from * from);
}

/// A section at one station along the span; lengths in metres, but thickness and camber in chords.
struct Section
{
  double x;      ///< Of the leading edge.
  double offset; ///< Of the chord line, in the direction of the thickness.
  double chord;
  double thickness;
  double crest;
};
using SectionAt = std::function<Section(double span)>;

/// Point of the section (x, thickness): u runs from the trailing edge along the lower side (-1) to
/// the leading edge (0) and back along the upper side (1).
std::pair<double, double> onSection(const Section& section, double u)
{
  const double side = u < 0 ? -1 : 1;
  const double height =
    camber(u * u, section.crest) + side * section.thickness * halfThickness(side * u);
  return { section.x + section.chord * u * u, section.offset + section.chord * height };
}

TopoDS_Shape wing(Layout layout)
{
  const SectionAt at = [](double y)
  {
    return Section{ 0.78 + y * (0.38 + 0.06 * y), -0.065 + y * (0.06 + 0.035 * y),
      0.34 + y * (-0.3 + 0.085 * y), 0.13 - 0.03 * y, 0.02 };
  };
  const auto surface = [&](double u, double y)
  {
    const auto [x, z] = onSection(at(y), u);
    return point(x, y, z);
  };
  const Stations ribs{ 0.04, 0.16, 0.22, 0.29, 0.34, 0.39, 0.47, 0.55, 0.63, 0.71, 0.79, 0.87,
    0.95 };
  return solidOf(interpolate(surface, spaced(-1, 1, 10), ribs), layout, 5, 12);
}

TopoDS_Shape tailplane(Layout layout)
{
  const SectionAt at = [](double y) {
    return Section{ 1.64 + y * (0.4 + 0.15 * y), 0.05 + 0.04 * y, 0.2 - 0.25 * y, 0.09, 0 };
  };
  const auto surface = [&](double u, double y)
  {
    const auto [x, z] = onSection(at(y), u);
    return point(x, y, z);
  };
  return solidOf(
    interpolate(surface, spaced(-1, 1, 6), { 0.012, 0.11, 0.16, 0.21, 0.26, 0.31, 0.36 }), layout,
    3, 6);
}

TopoDS_Shape fin(Layout layout)
{
  const SectionAt at = [](double z) {
    return Section{ 1.46 + 0.62 * z, 0, 0.32 - 0.34 * z, 0.1, 0 };
  };
  const auto surface = [&](double u, double z)
  {
    const auto [x, y] = onSection(at(z), u);
    return point(x, y, z);
  };
  return solidOf(
    interpolate(surface, spaced(-1, 1, 7), { 0.075, 0.17, 0.24, 0.31, 0.38, 0.45 }), layout, 3, 5);
}

// Nacelle and pylon hang under the wing at this span.
constexpr double nacelleY = 0.365, nacelleX = 0.8, nacelleZ = -0.14;

struct ProfileArc
{
  std::vector<gp_XYZ> points; ///< (x, radius), from the nacelle's lip.
  gp_XYZ start, end;          ///< Directions at its ends.
};

/// Spinner, fan, inlet with cowl, base and plug; they meet in creases.
std::vector<ProfileArc> nacelleProfile()
{
  return {
    { { { 0.03, 0, 0 }, { 0.05, 0.013, 0 } }, { 0, 1, 0 }, { 1, 0.4, 0 } },
    { { { 0.05, 0.013, 0 }, { 0.05, 0.034, 0 } }, { 0, 1, 0 }, { 0, 1, 0 } },
    { { { 0.05, 0.034, 0 }, { 0, 0.039, 0 }, { 0.06, 0.0495, 0 }, { 0.12, 0.0485, 0 },
        { 0.2, 0.036, 0 } },
      { -1, 0, 0 }, { 1, -0.2, 0 } },
    { { { 0.2, 0.036, 0 }, { 0.2, 0.026, 0 } }, { 0, -1, 0 }, { 0, -1, 0 } },
    { { { 0.2, 0.026, 0 }, { 0.26, 0, 0 } }, { 1, -0.1, 0 }, { 0, -1, 0 } },
  };
}

/// Parameters along an arc: its points' distances.
Stations chordLengths(const std::vector<gp_XYZ>& points)
{
  Stations lengths{ 0 };
  for (std::size_t i = 1; i < points.size(); ++i)
  {
    lengths.push_back(lengths.back() + (points[i] - points[i - 1]).Modulus());
  }
  return lengths;
}

TopoDS_Shape nacelle(Layout layout)
{
  const int sectors = layout == Layout::Plain ? 3 : 8;
  const double angle = 2 * pi / sectors;
  Patches patches;
  for (const ProfileArc& arc : nacelleProfile())
  {
    const Stations knots = chordLengths(arc.points);
    std::vector<gp_XYZ> poles =
      interpolateCurve(arc.points, knots, arc.start.Normalized(), arc.end.Normalized());
    for (gp_XYZ& pole : poles)
    {
      pole *= metre;
    }
    for (int k = 0; k < sectors; ++k)
    {
      const auto surface = revolve(poles, knots, angle * (k + 0.5), angle);
      cut(surface, stride(layout, static_cast<int>(knots.size())), 1, patches);
    }
  }
  gp_Trsf placement;
  placement.SetTranslation(gp_Vec(point(nacelleX, nacelleY, nacelleZ)));
  return BRepBuilderAPI_Transform(aeroplane::solidOf(patches), placement).Shape();
}

TopoDS_Shape pylon(Layout layout)
{
  const SectionAt at = [](double z) {
    return Section{ 0.864 + 1.1 * (z - nacelleZ - 0.02), nacelleY, 0.112, 0.125, 0 };
  };
  const auto surface = [&](double u, double z)
  {
    const auto [x, y] = onSection(at(z), u);
    return point(x, y, z);
  };
  const Stations sections{ nacelleZ + 0.02, nacelleZ + 0.07, nacelleZ + 0.1 };
  return solidOf(interpolate(surface, spaced(-1, 1, 4), sections), layout, 2, 2);
}

} // namespace

std::vector<Part> makeParts(Layout layout)
{
  enum Color
  {
    Red = 2,
    Green,
    Blue,
    Yellow,
    Magenta,
    Cyan,
    White
  };
  std::vector<Part> parts{ { "FUSELAGE", White, fuselage::solid(layout) },
    { "CANOPY", Cyan, canopy(layout) }, { "FIN", Red, fin(layout) } };
  for (const Part& part :
    { Part{ "WING", Blue, wing(layout) }, Part{ "TAILPLN", Yellow, tailplane(layout) },
      Part{ "NACELLE", Green, nacelle(layout) }, Part{ "PYLON", Magenta, pylon(layout) } })
  {
    parts.push_back(part);
    parts.push_back({ part.name, part.color, mirrored(part.solid) });
  }
  return parts;
}

} // namespace aeroplane
