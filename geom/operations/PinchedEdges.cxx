#include <cadrefine/operations/PinchedEdges.h>

#include <cadrefine/base/DisjointSets.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>

namespace cadrefine
{
namespace
{

/// What of an edge is on one side of a pinch.
struct Side
{
  Cavity cavity;      ///< Its cells and its two facets, to be halved.
  ClosestPoint place; ///< Where the middle is wanted.
  Index middle = -1;
};

/// The parts of its way that the middle of an edge may begin with.
constexpr std::array parts{ 1.0, 0.5, 0.25, 0.125 };

class PinchOpener
{
public:
  PinchOpener(EditableMesh& mesh, const SurfaceRule& rule)
    : mesh_(mesh), rule_(rule), oldVertices_(mesh.vertexCount())
  {
  }

  OperationResult run()
  {
    const auto count = static_cast<Index>(mesh_.facets().size());
    for (Index facet = 0; facet < count; ++facet)
    {
      for (int k = 0; k < 3 && mesh_.facets().exists(facet); ++k)
      {
        const auto& corners = mesh_.facets()[facet].corners;
        open(corners[k], corners[(k + 1) % 3]);
      }
    }
    return std::move(result_);
  }

private:
  void open(Index a, Index b)
  {
    if (!mayBeOpened(a, b))
    {
      return;
    }
    std::vector<Side> sides = sidesOf(a, b);
    if (sides.size() < 2)
    {
      return;
    }
    numberMiddles(sides);
    if (!std::all_of(sides.begin(), sides.end(), [&](Side& side) { return halve(a, b, side); }))
    {
      return;
    }
    sides.back().cavity.segments = { mesh_.segmentOf(a, b) };
    for (const Side& side : sides)
    {
      mesh_.replace(side.cavity);
      result_.added.push_back({ { a, b }, true, side.place });
      ++result_.counts.splits;
    }
  }

  /// Whether more than two facets meet at an edge, all on the CAD, but on none of its edges.
  bool mayBeOpened(Index a, Index b) const
  {
    const Index segment = mesh_.segmentOf(a, b);
    const std::vector<Index> facets = mesh_.facets().at(a, b);
    return facets.size() > 2 && !mesh_.areOnRim(a, b) && segment >= 0 &&
           mesh_.segments()[segment].parent < 0 &&
           mesh_.segments()[segment].edgeClass.kind == EdgeClass::Smooth &&
           std::all_of(facets.begin(), facets.end(),
             [&](Index facet) { return mesh_.facets()[facet].label >= 0; });
  }

  /// The cells at an edge, those that are joined at faces together, with the facets at them.
  std::vector<Side> sidesOf(Index a, Index b) const
  {
    const std::vector<Index> cells = mesh_.cells().at(a, b);
    DisjointSets groups(cells.size());
    std::map<Index, std::int32_t> cellAt; // by the third corner of a face
    for (std::size_t c = 0; c < cells.size(); ++c)
    {
      for (const Index corner : mesh_.cells()[cells[c]].corners)
      {
        if (corner != a && corner != b)
        {
          const auto number = static_cast<std::int32_t>(c);
          groups.join(cellAt.emplace(corner, number).first->second, number);
        }
      }
    }
    const auto of = groups.representatives();
    std::map<std::int32_t, Side> sides;
    for (std::size_t c = 0; c < cells.size(); ++c)
    {
      sides[of[c]].cavity.cells.push_back(cells[c]);
    }
    for (const Index facet : mesh_.facets().at(a, b))
    {
      for (const Index corner : mesh_.facets()[facet].corners)
      {
        if (corner != a && corner != b)
        {
          sides[of[cellAt.at(corner)]].cavity.facets.push_back(facet);
        }
      }
    }
    std::vector<Side> list;
    std::transform(sides.begin(), sides.end(), std::back_inserter(list),
      [](auto& side) { return std::move(side.second); });
    return list;
  }

  /// Vertices that were not needed before are used again.
  void numberMiddles(std::vector<Side>& sides)
  {
    std::size_t next = oldVertices_ + result_.added.size();
    for (Side& side : sides)
    {
      side.middle = static_cast<Index>(next++);
    }
    while (mesh_.vertexCount() < next)
    {
      mesh_.addVertex({});
    }
  }

  /// Halves a side, with the middle so far on its way that its own place is the nearest. Returns
  /// false where that is not possible.
  bool halve(Index a, Index b, Side& side)
  {
    const Vector3 towards = -1.0 * normalized(mesh_.sideOf(side.cavity.facets));
    const auto place = rule_.placeBesideMiddle(mesh_, a, b, towards);
    if (!place || side.cavity.facets.size() != 2)
    {
      return false;
    }
    side.place = *place;
    cadrefine::halve(mesh_, a, b, side.middle, side.cavity);
    const Point3 middle = 0.5 * (mesh_.vertex(a).point + mesh_.vertex(b).point);
    return std::any_of(parts.begin(), parts.end(),
      [&](double part)
      {
        EditableMesh::Vertex vertex;
        vertex.point = middle + part * (place->point - middle);
        vertex.wanted = place->point;
        vertex.entity = place->entity;
        mesh_.setVertex(side.middle, vertex);
        const Point3 nearest = rule_.projector().nearestOn(vertex.entity, vertex.point).point;
        return dot(nearest - middle, towards) > 0 && mesh_.isValid(side.cavity);
      });
  }

  EditableMesh& mesh_;
  const SurfaceRule& rule_;
  const std::size_t oldVertices_;
  OperationResult result_;
};

} // namespace

OperationResult openPinchedEdges(EditableMesh& mesh, const SurfaceRule& rule)
{
  return PinchOpener(mesh, rule).run();
}

} // namespace cadrefine
