// The CAD model as the rest of CADRefine sees it: no type of Open CASCADE appears here.
#pragma once

#include <cadrefine/base/BoundingBox.h>
#include <cadrefine/base/EntityId.h>
#include <cadrefine/base/ParallelFor.h>
#include <cadrefine/base/Vector3.h>
#include <cadrefine/cad/model/CADReport.h>
#include <cadrefine/nurbs/ClosestPointSearch.h>
#include <cadrefine/nurbs/NurbsModel.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cadrefine
{

/// What the file says of an entity beside its geometry.
struct EntityAttributes
{
  std::string name;                           ///< Empty: none.
  std::optional<std::array<float, 3>> colour; ///< RGB in [0, 1].
};

/// An immutable CAD model, safe from many threads at once. Coordinates are the file's own numbers,
/// or in the unit that was asked for (see readCADFile).
class CADModel
{
public:
  /// The model that `bytes` (from toBytes) holds; ids and coordinates are those of the model that
  /// was written. Throws Error where the bytes are not a model.
  static std::shared_ptr<const CADModel> fromBytes(
    const std::vector<char>& bytes, const ParallelFor& parallelFor = serialFor);
  std::vector<char> toBytes() const;

  ~CADModel();
  CADModel(const CADModel&) = delete;
  CADModel& operator=(const CADModel&) = delete;

  const NurbsModel& nurbs() const;
  int count(int dimension) const { return nurbs().count(dimension); }
  /// Diagonal of the bounding box.
  double size() const;
  /// Box round the trimmed model, to 1e-6 of its size. The first call finds it, once for all
  /// threads.
  BoundingBox box() const;
  /// Area of a face (see areaOf), length of an edge; 0 of a vertex. The first call for a dimension
  /// measures all of it, once for all threads.
  double measure(EntityId entity) const;
  /// The largest distance found between the trim curves of faces and their edges (see
  /// trimDeviation).
  double trimDeviation() const;
  /// How far patches may lie off surfaces that had to be fitted (offset surfaces).
  double fitError() const;
  const CADReport& report() const;
  const std::string& unit() const { return report().unit; }
  const std::vector<UnreadEntity>& unread() const { return report().unread; }
  /// Name and colour of a face or an edge; without either for a vertex.
  const EntityAttributes& attributes(EntityId entity) const;

  /// See ClosestPointSearch. The first query of a model builds the search structure, once for all
  /// threads; every later one only reads it.
  ClosestPoint nearest(const Point3& point, const SearchScope& scope = {}) const;
  bool isWithinDistance(const Point3& point, const SearchScope& scope) const;
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

private:
  friend class CADModelBuilder;
  struct Implementation;
  explicit CADModel(std::unique_ptr<const Implementation> implementation);
  std::unique_ptr<const Implementation> implementation_;
};

} // namespace cadrefine
