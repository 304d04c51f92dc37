#include "classification/OddFacets.h"

#include <cadrefine/base/IndicesWhere.h>
#include <cadrefine/classification/CADAdjacency.h>

#include <algorithm>
#include <tuple>

namespace cadrefine
{
namespace
{

/// Whether a face has one rim alone, as a dome, unlike a pipe: all edges that it shares with others
/// are joined.
bool endsThere(const NurbsModel& model, std::int32_t face)
{
  std::vector<std::int32_t> left;
  for (const std::int32_t edge : model.faces[face].edges)
  {
    if (!isSeam(model.edges[edge]))
    {
      left.push_back(edge);
    }
  }
  std::vector<std::int32_t> vertices; // of what is joined to the first edge
  const auto isJoined = [&](std::int32_t edge)
  {
    const NurbsEdge& curve = model.edges[edge];
    const auto isKnown = [&](std::int32_t vertex)
    { return vertex >= 0 && std::count(vertices.begin(), vertices.end(), vertex) > 0; };
    return isKnown(curve.firstVertex) || isKnown(curve.lastVertex);
  };
  for (auto next = left.begin(); next != left.end();
       next = std::find_if(left.begin(), left.end(), isJoined))
  {
    vertices.push_back(model.edges[*next].firstVertex);
    vertices.push_back(model.edges[*next].lastVertex);
    left.erase(next);
  }
  return left.empty();
}

/// What all tell: `none` yet, one value, or -1 where they tell different ones.
struct Common
{
  static constexpr std::int32_t none = -2;

  std::int32_t value = none;

  void add(Common other)
  {
    value = value == none || value == other.value ? other.value : other.value == none ? value : -1;
  }
};

/// What surrounds a patch of odd facets that meet at edges.
struct Surroundings
{
  unsigned char isWide = 0; ///< It is a patch of several facets, or a quadrilateral.
  /// A facet off the CAD is beside it; or nothing, but on a surface in space, which may end
  /// anywhere, two facets on the CAD at one edge, which goes on without it, as beside a rib.
  unsigned char isOpen = 0;
  unsigned char isAtBorder = 0; ///< A CAD edge that bounds one face alone is beside it.
  unsigned char isTied = 0;  ///< A facet from which it turns by less than 60 degrees is beside it.
  unsigned char isAmid = 0;  ///< A facet without a CAD edge between them is beside it.
  unsigned char isAlong = 0; ///< A mesh edge inside it joins vertices on one CAD edge.
  /// Bits for facets beyond `edge`, a CAD edge between two faces: 1, one is on the first face; 2,
  /// on the second.
  unsigned char sides = 0;
  Common edge;
  Common face; ///< The face of the patch.

  /// Whether the patch is on the CAD. It is not where a mesh ends at the rim of a CAD face which it
  /// leaves out: there facets of other faces alone are round the patch, and the face goes on to
  /// another rim. Nor is a bulkhead at the border of a surface in space.
  bool isOnCAD(const NurbsModel& model, bool ofSurface) const
  {
    if (ofSurface)
    {
      return !isOpen && !isAtBorder;
    }
    const bool isEnd = face.value >= 0 && endsThere(model, face.value);
    const bool isBetween = edge.value >= 0 && sides == 3;
    const bool isBeyond = sides > 0 ? isAmid || isEnd || isBetween : isAlong;
    return !isOpen && (!isWide || (!isAtBorder && (isTied || isBeyond)));
  }

  void add(const Surroundings& other)
  {
    isWide |= other.isWide;
    isOpen |= other.isOpen;
    isAtBorder |= other.isAtBorder;
    isTied |= other.isTied;
    isAmid |= other.isAmid;
    isAlong |= other.isAlong;
    sides |= other.sides;
    edge.add(other.edge);
    face.add(other.face);
  }

  friend bool operator==(const Surroundings& a, const Surroundings& b)
  {
    const auto all = [](const Surroundings& s)
    {
      return std::tuple(s.isWide, s.isOpen, s.isAtBorder, s.isTied, s.isAmid, s.isAlong, s.sides,
        s.edge.value, s.face.value);
    };
    return all(a) == all(b);
  }
};

/// The side of a triangle that is opposite to an obtuse angle; -1: there is none.
int longSide(const Mesh& mesh, const Facet& triangle)
{
  for (int k = 0; k < 3; ++k)
  {
    const Point3& a = mesh.points[triangle.vertices[k]];
    const Point3& b = mesh.points[triangle.vertices[(k + 1) % 3]];
    const Point3& c = mesh.points[triangle.vertices[(k + 2) % 3]];
    if (dot(a - c, b - c) < 0)
    {
      return k;
    }
  }
  return -1;
}

/// The face of the neighbour from which the surface turns least, for an ear, or that of all
/// neighbours; -1: they are not on one face.
std::int32_t faceOfNeighbours(const FacetRecord& facet, const std::vector<FacetRecord>& neighbours)
{
  const auto turnsLess = [&](const FacetRecord& a, const FacetRecord& b)
  {
    const double ofA = dot(a.normal, facet.normal);
    const double ofB = dot(b.normal, facet.normal);
    return ofA > ofB || (ofA == ofB && a.face < b.face);
  };
  const auto nearest = std::min_element(neighbours.begin(), neighbours.end(), turnsLess);
  const bool isDecided =
    facet.ear >= 0 || std::all_of(neighbours.begin(), neighbours.end(),
                        [&](const FacetRecord& other) { return other.face == nearest->face; });
  return isDecided ? nearest->face : -1;
}

/// What a facet beside one of a patch tells, given the CAD edges that both ends of the mesh edge
/// between them lie on.
Surroundings seenFrom(const FacetRecord& facet, const FacetRecord& other, const NurbsModel& model,
  const std::vector<std::int32_t>& edgesOfEnds)
{
  Surroundings seen;
  if (!other.onCAD)
  {
    seen.isOpen = 1;
    return seen;
  }
  const auto between = std::find_if(edgesOfEnds.begin(), edgesOfEnds.end(),
    [&](std::int32_t edge)
    {
      const auto& faces = model.edges[edge].faces;
      return std::binary_search(faces.begin(), faces.end(), other.face) &&
             !isSeam(model.edges[edge]);
    });
  if (between == edgesOfEnds.end())
  {
    seen.isTied = fitsEitherWay(other.normal, facet.normal);
    seen.isAmid = 1;
    seen.face.value = other.face;
    return seen;
  }
  const auto& faces = model.edges[*between].faces;
  seen.isAtBorder = faces.size() == 1;
  if (faces.size() == 2)
  {
    seen.sides = other.face == faces[0] ? 1 : 2;
    seen.edge.value = *between;
    seen.face.value = faces[0] + faces[1] - other.face;
  }
  return seen;
}

/// For each odd facet what is round its patch. Collective.
std::vector<Surroundings> findSurroundings(RankExchange& exchange,
  const DistributedBoundary& boundary, const std::vector<EntityId>& entities,
  const NurbsModel& model, const std::vector<FacetRecord>& records,
  const std::vector<std::vector<FacetRecord>>& ofEdges, const std::vector<Index>& odd)
{
  std::vector<Surroundings> ofPatches(odd.size());
  const auto forEdges = [&](const auto& use)
  {
    for (std::size_t i = 0; i < odd.size(); ++i)
    {
      for (int k = 0; k < boundary.facets[odd[i]].edges(); ++k)
      {
        use(boundary.facetEdges[odd[i]][k], odd[i], ofPatches[i]);
      }
    }
  };
  forEdges(
    [&](Index edge, Index facet, Surroundings& patch)
    {
      const auto [a, b] = boundary.edges.edges()[edge];
      const auto onBoth = commonEntities(model, entities[a], entities[b], 1);
      int count = 0;
      for (const FacetRecord& other : ofEdges[edge])
      {
        count += other.odd;
        if (!other.odd)
        {
          patch.add(seenFrom(records[facet], other, model, onBoth));
        }
      }
      patch.isWide |= count > 1 || boundary.facets[facet].corners() == 4;
      patch.isAlong |= count > 1 && !onBoth.empty();
      patch.isOpen |=
        boundary.ofSurface ? facetsOnCAD(ofEdges[edge]).size() > 1 : ofEdges[edge].size() == 1;
    });
  bool changes = true;
  while (exchange.any(changes))
  {
    std::vector<Surroundings> atEdges(ofEdges.size());
    forEdges([&](Index edge, Index, const Surroundings& patch) { atEdges[edge].add(patch); });
    combineShared(exchange, boundary.sharedEdges, atEdges,
      [](Surroundings a, const Surroundings& b)
      {
        a.add(b);
        return a;
      });
    changes = false;
    forEdges(
      [&](Index edge, Index, Surroundings& patch)
      {
        const Surroundings before = patch;
        patch.add(atEdges[edge]);
        changes = changes || !(patch == before);
      });
  }
  return ofPatches;
}

} // namespace

bool joinOddFacets(RankExchange& exchange, const Mesh& mesh, const DistributedBoundary& boundary,
  const std::vector<EntityId>& entities, const CADModel& model,
  const std::vector<std::vector<FacetRecord>>& ofEdges, std::vector<FacetRecord>& records)
{
  const auto odd = indicesWhere(records.size(), [&](std::size_t f) { return records[f].odd; });
  if (!exchange.any(!odd.empty()))
  {
    return false;
  }
  const auto ofPatches =
    findSurroundings(exchange, boundary, entities, model.nurbs(), records, ofEdges, odd);
  for (std::size_t i = 0; i < odd.size(); ++i)
  {
    FacetRecord& record = records[odd[i]];
    const ClassifiedFacet facet = classifiedFacet(mesh, entities, boundary.facets[odd[i]]);
    std::vector<FacetRecord> neighbours;
    for (int k = 0; k < boundary.facets[odd[i]].edges(); ++k)
    {
      const auto onCAD = facetsOnCAD(ofEdges[boundary.facetEdges[odd[i]][k]]);
      neighbours.insert(neighbours.end(), onCAD.begin(), onCAD.end());
    }
    const auto faces = commonFaces(model.nurbs(), facet.entities, facet.corners);
    const auto isCommon = [&](std::int32_t face)
    { return std::binary_search(faces.begin(), faces.end(), face); };
    const Surroundings& patch = ofPatches[i];
    std::int32_t face = patch.face.value;
    if (!isCommon(face) && !neighbours.empty())
    {
      face = faceOfNeighbours(record, neighbours);
    }
    face = isCommon(face) ? face : -1;
    const bool isEar = record.ear >= 0 && (patch.isTied || !patch.isWide);
    record.onCAD = patch.isOnCAD(model.nurbs(), boundary.ofSurface) || (isEar && face >= 0);
    record.face = record.onCAD ? face : -1;
  }
  return true;
}

bool joinEars(RankExchange& exchange, const Mesh& mesh, const DistributedBoundary& boundary,
  const NurbsModel& model, const std::vector<std::vector<FacetRecord>>& ofEdges,
  std::vector<FacetRecord>& records)
{
  bool changes = false;
  for (std::size_t f = 0; f < records.size(); ++f)
  {
    FacetRecord& record = records[f];
    const int side = record.onCAD && record.ear >= 0 ? longSide(mesh, boundary.facets[f]) : -1;
    if (side < 0)
    {
      continue;
    }
    const auto& faces = model.edges[record.ear].faces;
    for (const FacetRecord& beyond : ofEdges[boundary.facetEdges[f][side]])
    {
      if (beyond.ear != record.ear && beyond.face != record.face &&
          std::binary_search(faces.begin(), faces.end(), beyond.face))
      {
        record.face = beyond.face;
        changes = true;
      }
    }
  }
  return exchange.any(changes);
}

} // namespace cadrefine
