// A mesh of tetrahedra or triangles whose cells may be exchanged for others.
#pragma once

#include <cadrefine/base/EntityId.h>
#include <cadrefine/classification/BoundaryProjector.h>
#include <cadrefine/mesh/Mesh.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace cadrefine
{

/// A cell, facet or segment with what it inherits from those that it replaces.
template<std::size_t Corners>
struct LabelledSimplex
{
  std::array<Index, Corners> corners;
  Index label = 0;   ///< Simplices of different labels are not joined.
  Index parent = -1; ///< Its number in the mesh that was there at first; -1: none.
};

/// A segment, which also carries the class by which its middle is placed on the CAD.
template<>
struct LabelledSimplex<2>
{
  std::array<Index, 2> corners;
  Index label = 0;
  Index parent = -1;
  EdgeClass edgeClass = {};
};

template<std::size_t Corners>
bool hasCorner(const std::array<Index, Corners>& corners, Index vertex)
{
  return std::find(corners.begin(), corners.end(), vertex) != corners.end();
}

/// The corners in ascending order: equal for cells with the same corners.
template<std::size_t Corners>
std::array<Index, Corners> sorted(std::array<Index, Corners> corners)
{
  std::sort(corners.begin(), corners.end());
  return corners;
}

/// Whether corner `b` of a triangle follows its corner `a`.
bool goesAlong(const std::array<Index, 3>& triangle, Index a, Index b);

/// The simplices that an operation takes out of a mesh (by their numbers), and those that it puts
/// there. The cells of a mesh of triangles are its facets.
struct Cavity
{
  std::vector<Index> cells;
  std::vector<Index> facets;
  std::vector<Index> segments;
  std::vector<LabelledSimplex<4>> newCells;
  std::vector<LabelledSimplex<3>> newFacets;
  std::vector<LabelledSimplex<2>> newSegments;
  /// For each new facet of a mesh of triangles, a normal (of any length) of the facets that it
  /// replaces, from the end of which it has to turn as they do.
  std::vector<Vector3> sides = {};

  void clear();

  /// The cells of a mesh of this dimension.
  template<int Dimension>
  const std::vector<Index>& cellsOf() const
  {
    if constexpr (Dimension == 3)
    {
      return cells;
    }
    else
    {
      return facets;
    }
  }
  template<int Dimension>
  std::vector<LabelledSimplex<Dimension + 1>>& newCellsOf()
  {
    if constexpr (Dimension == 3)
    {
      return newCells;
    }
    else
    {
      return newFacets;
    }
  }
  template<int Dimension>
  const std::vector<LabelledSimplex<Dimension + 1>>& newCellsOf() const
  {
    if constexpr (Dimension == 3)
    {
      return newCells;
    }
    else
    {
      return newFacets;
    }
  }
};

/// Simplices that can be added and removed, with lists of those at each vertex. The number of a
/// removed simplex is not used again.
template<std::size_t Corners>
class SimplexStore
{
public:
  using Simplex = LabelledSimplex<Corners>;

  Index add(const Simplex& simplex);
  void remove(Index simplex);
  /// Returns to when there were `size` simplices: deletes those added since, restores those in
  /// `removed`.
  void takeBack(std::size_t size, const std::vector<Index>& removed);
  void addVertex() { at_.emplace_back(); }

  std::size_t size() const { return simplices_.size(); }
  bool exists(Index simplex) const { return exists_[simplex] != 0; }
  const Simplex& operator[](Index simplex) const { return simplices_[simplex]; }
  /// The numbers of the simplices at a vertex, in the order in which they were added.
  const std::vector<Index>& at(Index vertex) const { return at_[vertex]; }
  /// The numbers of the simplices at both vertices, in the order in which they were added.
  std::vector<Index> at(Index a, Index b) const;
  void at(Index a, Index b, std::vector<Index>& result) const;

private:
  std::vector<Simplex> simplices_;
  std::vector<unsigned char> exists_;
  std::vector<std::vector<Index>> at_;
};

/// Tetrahedra, the facets that are to be kept up (of the boundary, and others that are listed) and
/// the segments along which facets must not be joined: creases, the rims of facets, where labels
/// change, and listed ones. A mesh of triangles, in the plane or on a surface in space, has no
/// tetrahedra: its cells are the facets, and in the plane its boundary is segments. Vertices have
/// two places: where they are, in which cells have to be valid, and where they are wanted (on the
/// CAD), in which the shape of cells is judged.
class EditableMesh
{
public:
  enum class Kind
  {
    Solid,  ///< Tetrahedra, whose boundary is facets.
    Plane,  ///< Triangles, whose boundary is segments.
    Surface ///< Triangles that are the boundary themselves.
  };

  struct Vertex
  {
    Point3 point;
    Point3 wanted;
    EntityId entity;             ///< CAD entity that it lies on; none: it is not on the CAD.
    bool stays = false;          ///< It is not moved or taken out.
    bool isOnRim = false;        ///< It has cells beyond this mesh, and stays.
    bool isBesideOthers = false; ///< It is on the rim for cells that are no simplices.
  };

  /// How freely a vertex may be moved or taken out: in space, on facets of one label, along
  /// segments of one label, or not at all.
  enum class Freedom
  {
    None,
    Segment,
    Facet,
    Space
  };

  EditableMesh() = default;
  /// `plane` is the unit normal of a planar mesh, from whose end its triangles turn
  /// counter-clockwise; where it is zero, triangles keep the side that they have.
  explicit EditableMesh(Kind kind, const Vector3& plane = {}) : kind_(kind), plane_(plane) {}

  Index addVertex(const Vertex& vertex);
  void addCell(const LabelledSimplex<4>& cell) { cells_.add(cell); }
  void addFacet(const LabelledSimplex<3>& facet) { facets_.add(facet); }
  void addSegment(const LabelledSimplex<2>& segment) { segments_.add(segment); }
  /// To be called when all simplices are there. Adds a segment wherever the facets at an edge are
  /// not two of one label, or are off the CAD (labels below 0) and not in one plane; along segments
  /// of the latter kind, if straight, vertices may go. In a mesh of triangles also where two facets
  /// do not turn alike.
  void closeFacets();
  /// The class of an edge that is not on a CAD edge: on the face of the facets on the CAD that have
  /// it (labels of 0 and more), or off the CAD where there are none.
  EdgeClass classBeside(Index a, Index b) const;

  Kind kind() const { return kind_; }
  int dimension() const { return kind_ == Kind::Solid ? 3 : 2; }
  const Vector3& plane() const { return plane_; }
  std::size_t vertexCount() const { return vertices_.size(); }
  const Vertex& vertex(Index v) const { return vertices_[v]; }
  void setVertex(Index v, const Vertex& vertex);
  /// Moves a vertex to a point, where it is from then on also wanted.
  void moveVertex(Index v, const Point3& point);
  const SimplexStore<4>& cells() const { return cells_; }
  const SimplexStore<3>& facets() const { return facets_; }
  const SimplexStore<2>& segments() const { return segments_; }
  /// The cells of a mesh of this dimension.
  template<int Dimension>
  const SimplexStore<Dimension + 1>& cellsOf() const
  {
    if constexpr (Dimension == 3)
    {
      return cells_;
    }
    else
    {
      return facets_;
    }
  }

  /// Whether both vertices have cells beyond this mesh: then an edge between them may exist there,
  /// or have cells there.
  bool areOnRim(Index a, Index b) const { return vertices_[a].isOnRim && vertices_[b].isOnRim; }
  Freedom freedomOf(Index v) const;
  bool haveOneLabel(const std::vector<Index>& cells) const;
  bool hasFacet(const std::array<Index, 3>& corners) const;
  /// Whether a vertex lies in the plane of a facet, or on the line of a segment, but for rounding
  /// of the coordinates.
  bool isInSpanOf(const std::array<Index, 3>& facet, Index v) const;
  bool isInSpanOf(const std::array<Index, 2>& segment, Index v) const;
  /// The segment between two vertices; -1: none.
  Index segmentOf(Index a, Index b) const;

  /// Mean ratio of a cell with its vertices where they are wanted; negative if it is inverted there
  /// (for a triangle in space: if it would turn over on the way there).
  double quality(const std::array<Index, 4>& cell) const;
  double quality(const std::array<Index, 3>& cell) const;
  /// The quality of a cell of the mesh, by its number (in a mesh of triangles, that of a facet).
  /// Computed once, and again when a vertex of the cell has changed.
  double qualityOf(Index cell) const;
  /// Mean ratio of a cell with its vertices where they are.
  double currentQuality(const std::array<Index, 4>& cell) const;
  double currentQuality(const std::array<Index, 3>& cell) const;
  /// Whether a cell is valid with its vertices where they are; exact (for triangles as far as
  /// turnOf is). A triangle is valid if it turns counter-clockwise, seen from the end of the
  /// plane's normal, or of `side` where there is none.
  bool isValid(const std::array<Index, 4>& cell, const Vector3& side = {}) const;
  bool isValid(const std::array<Index, 3>& cell, const Vector3& side) const;
  /// The smallest quality of these cells, given by their numbers; infinite if there are none.
  double worst(const std::vector<Index>& cells) const;
  /// Whether all new cells of the cavity are valid.
  bool isValid(const Cavity& cavity) const;
  /// Twice the sum of area times unit normal over these facets, with the vertices where they are.
  Vector3 sideOf(const std::vector<Index>& facets) const;
  /// Whether replacing the cavity changes or cuts the boundary.
  bool touchesBoundary(const Cavity& cavity) const;

  /// Exchanges the simplices of the cavity. The numbers of the new ones are the last ones.
  void replace(const Cavity& cavity);

  /// Takes back these replacements, which have to be the last ones, and returns a single cavity
  /// that does the same as all of them.
  Cavity takeBack(const std::vector<Cavity>& done);

private:
  /// Whether facets separate the cells of different labels at a vertex everywhere, so that it may
  /// go along these facets.
  bool labelsEndAtFacets(Index v) const;
  Vector3 areaVector(const std::array<Index, 3>& facet) const;
  void forgetQualities(Index v);

  Kind kind_ = Kind::Solid;
  Vector3 plane_{};
  std::vector<Vertex> vertices_;
  mutable std::vector<double> qualities_; ///< Quality of each cell; NaN, or no entry: not known.
  SimplexStore<4> cells_;
  SimplexStore<3> facets_;
  SimplexStore<2> segments_;
};

} // namespace cadrefine
