// From a shape of Open CASCADE to plain arrays. Private to geom/cad.
#pragma once

#include <cadrefine/base/ParallelFor.h>
#include <cadrefine/cad/extraction/ShapeIndex.h>
#include <cadrefine/nurbs/NurbsModel.h>

namespace cadrefine
{

/// The model of a shape that prepareShape made. The same shape gives the same bits, on any number
/// of threads.
NurbsModel extractNurbs(const ShapeIndex& index, const ParallelFor& parallelFor);

/// One face: patches, trim loops, orientation and tolerance; not its edges. Trim curves know theirs
/// where `index` is given.
NurbsFace extractFace(const TopoDS_Face& face, const ShapeIndex* index = nullptr);

/// One edge: its curve in space and its tolerance; not its neighbours.
NurbsEdge extractEdge(const TopoDS_Edge& edge);

/// One use of an edge by a face: a seam is used twice by the same one.
struct EdgeUse
{
  TopoDS_Edge edge; ///< Oriented as the face uses it.
  TopoDS_Face face;
};

/// Whether an edge with these uses is a crease, see NurbsEdge::sharp.
bool isSharp(const std::vector<EdgeUse>& uses);

} // namespace cadrefine
