// CAD models of simple shapes: made with Open CASCADE, written to a file and read back.
#pragma once

#include "TestFiles.h"

#include <cadrefine/base/Vector3.h>
#include <cadrefine/cad/model/CADModel.h>

#include <TopoDS_Shape.hxx>

#include <memory>
#include <string>

namespace cadtest
{

/// Sphere round the origin.
TopoDS_Shape sphere(double radius);
/// Torus round the z axis.
TopoDS_Shape torus(double majorRadius, double minorRadius);
/// Box from the origin to (x, y, z).
TopoDS_Shape box(double x, double y, double z);
/// Cylinder round the z axis from z = 0 to `height`.
TopoDS_Shape cylinder(double radius, double height);
/// What lies between two cylinders round the z axis, from z = 0 to `height`.
TopoDS_Shape pipe(double innerRadius, double outerRadius, double height);
/// A cylinder from z = 0 that a hemisphere ends on top.
TopoDS_Shape roundedCylinder(double radius, double height);
/// A disc round the z axis, flat to this radius and round beyond; as thick as twice the fillet's
/// radius, its middle at z = 0.
TopoDS_Shape filletedDisc(double radius, double fillet);
/// A cylinder of twice this height, its side of two faces.
TopoDS_Shape longCylinder(double radius, double height);
/// The lateral face of half a cylinder, where y is positive.
TopoDS_Shape halfPipe(double radius, double height);
/// The same of a cone with these radii at z = 0 and at the height.
TopoDS_Shape halfCone(double radius, double upperRadius, double height);
/// The side of a cylinder along z round an ellipse.
TopoDS_Shape ellipticPipe(double halfLength, double halfHeight, double width);
/// In the plane z = 0 round the origin; of its two edges one goes from the angle `turn` to pi -
/// turn, where y is positive.
TopoDS_Shape discOfTwoArcs(double radius, double turn);
/// The part of data/solid_mesh.py: a box with a hole through it and a round cavity.
TopoDS_Shape partWithCavity();
/// Circle in the plane z = 0 round the origin: an edge without a face.
TopoDS_Shape circle(double radius);
/// In the same plane, longer along x.
TopoDS_Shape ellipse(double longRadius, double shortRadius);
/// The rectangle from the origin to (x, y, 0): one face with four edges.
TopoDS_Shape rectangle(double x, double y);
/// Base at the origin, apex at height z.
TopoDS_Shape cone(double radius, double height);
/// Two such cones with one base, apexes at height z and -depth.
TopoDS_Shape doubleCone(double radius, double height, double depth);
/// A box with a ball about the origin, its corner, cut off.
TopoDS_Shape boxWithoutCorner(double x, double y, double z, double radius);
/// What lies between two spheres round the origin where no coordinate is negative.
TopoDS_Shape eighthOfShell(double innerRadius, double outerRadius);
/// Two unit boxes that have an edge in common and nothing else: no manifold.
TopoDS_Shape cubesAtAnEdge();
/// Three unit squares that have an edge in common, on the z axis.
TopoDS_Shape threeSheets();

/// The shape, moved; or scaled about the origin.
TopoDS_Shape moved(const TopoDS_Shape& shape, const cadrefine::Vector3& by);
TopoDS_Shape scaled(const TopoDS_Shape& shape, double factor);
/// Two shapes as one, not joined.
TopoDS_Shape together(const TopoDS_Shape& a, const TopoDS_Shape& b);

/// The shape of a BREP file; throws where it cannot be read.
TopoDS_Shape readShape(const std::string& path);

/// Writes `shape` into the folder with this extension (".step", ".igs", ".brep"); the file's path.
std::string writeInto(
  const TemporaryFolder& folder, const TopoDS_Shape& shape, const std::string& extension);

/// The model that readCADFile makes of `shape`.
std::shared_ptr<const cadrefine::CADModel> modelOf(
  const TopoDS_Shape& shape, const std::string& extension = ".step");

} // namespace cadtest
