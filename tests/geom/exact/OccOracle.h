// Open CASCADE's closest point of a trimmed model, made fast enough for thousands of points.
#pragma once

#include <cadrefine/base/EntityId.h>
#include <cadrefine/base/Vector3.h>

#include <TopoDS_Shape.hxx>

#include <limits>
#include <memory>

namespace exacttest
{

/// The oracle. It is BRepExtrema_DistShapeShape of a vertex and a shape, taken apart so that only
/// what can be nearest is looked at, and so that what depends on the shape alone is done once.
///
/// 1. BRepExtrema_DistShapeShape is the minimum, over the vertices, edges and faces of the shape,
/// of
///    the distances of: the vertices' points; the extrema on the edges' curves in space
///    (BRepExtrema_ExtPC, that is Extrema_ExtPC over the edge's range); the extrema on the faces'
///    surfaces (BRepExtrema_ExtPF, that is Extrema_ExtPS over the face's range of parameters) that
///    BRepClass_FaceClassifier, with the face's tolerance, finds inside of the face (TopAbs_IN).
///    This class takes the same minimum with the same classes, and of the extrema on the faces'
///    borders, which are those of Extrema_ExtPC on the trim curves on their surfaces
///    (BRepAdaptor_Curve of an edge and a face): BRepExtrema_DistShapeShape takes it that the edges
///    stand for these, but trim curves lie off their edges in most files.
/// 2. An edge or a part of a face is left out only if a box that holds it is farther than the limit
///    asked for. With the tested distance plus its tolerance as the limit, nothing that could show
///    this distance to be too large is left out.
/// 3. Extrema are searched block by block of the surface (see blocksOf): an extremum over the face
///    is one over a block, so the minimum is the same, and the search, which starts from a grid of
///    samples, has the denser grid.
/// 4. Three faults of BRepExtrema_DistShapeShape, which make it wrong by more than 1e-9 of the size
///    of some models, are avoided: it stops at parameters that are off by up to 1e-7 (here: 1e-12
///    of the size); it takes points of an edge's curve up to 1e-7 beyond the edge's end (here: the
///    end); and on a face that runs round its surface more than once it looks at one turn.
/// What is compared is the same on both sides: the union of the faces' surfaces within their trim
/// loops and on them, of the edges' curves in space, and of the vertices. The shape is the prepared
/// one (sewn and healed) that the model's NURBS were extracted from, so a difference is an error of
/// the extraction or of the search, not of the preparation.
class OccOracle
{
public:
  struct Nearest
  {
    cadrefine::EntityId entity;
    cadrefine::Point3 point{};
    double distance = std::numeric_limits<double>::infinity();
  };

  /// `size` is the shape's diagonal.
  OccOracle(const TopoDS_Shape& shape, double size);
  ~OccOracle();
  OccOracle(const OccOracle&) = delete;
  OccOracle& operator=(const OccOracle&) = delete;

  /// The nearest of what is not farther than `limit`; none where nothing is found.
  Nearest nearest(const cadrefine::Point3& q, double limit) const;

  /// True where `p` is not farther than `tolerance` from the entity: for a face, from a point of
  /// its surface that is inside of it or on its border by one of Open CASCADE's two classifiers
  /// (BRepClass_FaceClassifier and BRepTopAdaptor_FClass2d; each takes some points near corners for
  /// outside that are inside), or that is within the tolerance of one of the face's vertices, such
  /// as its pole.
  bool liesOn(cadrefine::EntityId entity, const cadrefine::Point3& p, double tolerance) const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

} // namespace exacttest
