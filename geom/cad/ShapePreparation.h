// From the shapes of a file to one sewn, healed model. Private to geom/cad.
#pragma once

#include <TopoDS_Shape.hxx>

namespace cadrefine
{

/// The model made of `shape`: free faces sewn, broken ones healed, closed shells turned outward,
/// free curves joined at their ends. Null where `shape` holds neither face nor curve.
TopoDS_Shape prepareShape(const TopoDS_Shape& shape);

/// Free curves that end in common vertices, where their ends lie within a tolerance of each other
/// that follows from their size.
TopoDS_Shape joinCurves(const TopoDS_Shape& edges);

} // namespace cadrefine
