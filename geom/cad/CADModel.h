// The CAD model as the rest of CADRefine sees it: no type of Open CASCADE appears here.
#pragma once

#include "CADReport.h"
#include "ClosestPointSearch.h"
#include "EntityId.h"
#include "NurbsModel.h"
#include "Vector3.h"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cadrefine
{

/// What the file says of an entity beside its geometry.
struct EntityLook
{
  std::string name;                           ///< Empty: none.
  std::optional<std::array<float, 3>> colour; ///< RGB in [0, 1].
};

/// Triangles or line segments that show one entity.
struct Tessellation
{
  std::vector<Point3> points;
  std::vector<Vector3> normals; ///< Of a face at its points, outward; zero where there is none.
  std::vector<std::array<int, 3>> triangles; ///< Of a face.
  std::vector<int> line;                     ///< Of an edge, a polyline.
};

/// An immutable CAD model, safe from many threads at once. Coordinates are the file's own numbers.
class CADModel
{
public:
  /// Deflection of drawings, as a part of the model's size.
  static constexpr double drawingTolerance = 1e-3;

  /// The model that `bytes` (from toBytes) holds; ids and coordinates are those of the model that
  /// was written. Throws Error where the bytes are not a model.
  static std::shared_ptr<const CADModel> fromBytes(const std::vector<char>& bytes);
  std::vector<char> toBytes() const;

  ~CADModel();
  CADModel(const CADModel&) = delete;
  CADModel& operator=(const CADModel&) = delete;

  const NurbsModel& nurbs() const;
  int count(int dimension) const { return nurbs().count(dimension); }
  /// Diagonal of the bounding box.
  double size() const;
  const CADReport& report() const;
  const std::string& unit() const { return report().unit; }
  const std::vector<UnreadEntity>& unread() const { return report().unread; }
  /// Name and colour of a face or an edge; without either for a vertex.
  const EntityLook& look(EntityId entity) const;

  /// See ClosestPointSearch. The first query of a model builds the search structure, once for all
  /// threads; every later one only reads it.
  ClosestPoint nearest(const Point3& point, const SearchScope& scope = {}) const;
  ClosestPoint nearestOn(EntityId entity, const Point3& point) const;

  /// Point of `entity` at `parameters` (see ClosestPoint::parameters).
  Point3 evaluate(EntityId entity, const std::array<double, 2>& parameters) const;
  /// Outward unit normal of a face; the zero vector where it is undefined even in the limit.
  Vector3 normal(int face, const std::array<double, 2>& parameters) const;
  /// Outward unit normal of a face at the point of its surface that is nearest to `point` (which
  /// may lie on the face's border).
  Vector3 normalNear(int face, const Point3& point) const;
  /// Unit tangent of an edge in the direction of growing t.
  Vector3 tangent(int edge, double t) const;

  /// True where `entity` is `of` or bounds it, directly or through an edge.
  bool inClosure(EntityId entity, EntityId of) const;

  /// Drawing of a face or an edge, to `deflection` (a length). A vertex has none. Depends on the
  /// entity and the deflection alone.
  Tessellation tessellate(EntityId entity, double deflection) const;

private:
  friend class CADModelBuilder;
  struct Implementation;
  explicit CADModel(std::unique_ptr<const Implementation> implementation);
  std::unique_ptr<const Implementation> implementation_;
};

} // namespace cadrefine
