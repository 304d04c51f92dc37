// From the shapes of a file to one sewn, healed model. Private to geom/cad.
#pragma once

#include <cadrefine/cad/import/ReadSteps.h>
#include <cadrefine/cad/readers/EntityAttributes.h>

#include <TopoDS_Compound.hxx>
#include <TopoDS_Shape.hxx>

#include <vector>

namespace cadrefine
{

struct PreparedShape
{
  TopoDS_Shape shape; ///< Null where there is neither face nor curve.
  double sewingTolerance = 0;
  std::vector<UnreadEntity> unread;  ///< Faces and curves without end, curves without length.
  std::vector<UnreadEntity> leftOut; ///< Open faces that are there twice.
};

/// Makes the shape of a model: free faces and open shells are sewn, broken ones healed, closed
/// shells turned outward, free curves joined at their ends. The attributes in `attributeMap`
/// follow.
PreparedShape prepareShape(
  const TopoDS_Shape& shape, AttributeMap& attributeMap, OptionalSteps& steps);

TopoDS_Compound compoundOf(const std::vector<TopoDS_Shape>& shapes);

struct BoundedFaces
{
  TopoDS_Shape shape;
  std::vector<TopoDS_Shape> removed;
};

/// Gives faces without an edge, which are the whole of their surface, its border and seams; removes
/// those whose surface has no end.
BoundedFaces boundFaces(const TopoDS_Shape& shape, AttributeMap& attributeMap);

struct DistinctFaces
{
  std::vector<TopoDS_Shape> faces;
  std::vector<TopoDS_Shape> repeated;
};

/// The faces that equal none before them bit by bit, geometry and loops. (Sewing takes a time that
/// grows with the cube of the number of faces in one place, and cannot tell them apart.) Work and
/// memory: one copy of each face.
DistinctFaces distinctFaces(const std::vector<TopoDS_Shape>& faces);

struct SewnFaces
{
  TopoDS_Shape shape;
  double tolerance = 0;
};

/// Sews faces with the smallest of the tolerances 1e-7, 1e-6, 1e-5 and 1e-4 of their size after
/// which the fewest edges stay open. A sewing that loses a face does not count.
SewnFaces sewFaces(const std::vector<TopoDS_Shape>& faces, AttributeMap& attributeMap);

struct JoinedCurves
{
  TopoDS_Shape shape;
  std::vector<UnreadEntity> lost; ///< Curves without end, or without length.
};

/// Joins free curves in common vertices, where their ends lie within a tolerance of each other that
/// follows from their size.
JoinedCurves joinCurves(const TopoDS_Shape& edges, AttributeMap& attributeMap);

/// Gives edges that have only trim curves a curve in space, where Open CASCADE can make one.
void buildCurvesInSpace(const TopoDS_Shape& shape);

} // namespace cadrefine
